#include "raster/shared_sequence.h"

#include <algorithm>
#include <cassert>

#include "raster/frame_passes.h"
#include "raster/lookup.h"
#include "raster/lookup_records.h"
#include "raster/sequence_impl.h"
#include "raster/shadow_maps.h"

namespace pb {
namespace {

// One that captures all that any of them shows: distances if a lookup reads them, and as many iterations as the most.
// These repeat lookups only if they do in all of the techniques: a single iteration repeats none, however it is called.
Technique capturingTechnique(const std::vector<Technique>& techniques) {
  const auto reader = std::ranges::find_if(techniques, needsDistances);
  Technique technique = reader == techniques.end() ? techniques.front() : *reader;
  if (!repeatsLookups(technique)) technique.iterations = Iterations::bruteForce;
  technique.bounces = std::ranges::max(techniques, {}, &Technique::bounces).bounces;
  assert(std::ranges::all_of(
      techniques, [&](const Technique& member) { return repeatsLookups(member) == repeatsLookups(technique); }));
  return technique;
}

}  // namespace

// A technique's own part of a frame.
struct SharedSequence::FinalPass {
  FinalPass(RasterDevice::Impl& device, const Technique& technique_)
      : technique(technique_), layout(technique), pass(device, technique) {}

  const Technique technique;
  ProbeLayout layout;
  ScenePass pass;
};

SharedSequence::SharedSequence(RasterDevice& device, const std::vector<Technique>& techniques, int widthPx,
                               int heightPx, int samplesPerAxis)
    : captures_(device, capturingTechnique(techniques), widthPx, heightPx, samplesPerAxis) {
  if (techniques.size() == 1) return;
  assert(!device.impl().fault.isPlanted());
  for (const Technique& technique : techniques) {
    checkSettings(technique);
    finalPasses_.push_back(std::make_unique<FinalPass>(device.impl(), technique));
  }
}

SharedSequence::~SharedSequence() { captures_.impl().device.context.makeCurrent(); }  // members free GL objects

void SharedSequence::capture(const std::shared_ptr<const Snapshot>& snapshot, bool countFragments) {
  snapshot_ = snapshot;
  countFragments_ = countFragments;
  if (finalPasses_.empty()) {
    ofSingle_ = captures_.renderFrame(*snapshot, countFragments);
    return;
  }
  FrameWork work{.fragmentCount = captures_.impl().fragmentCount(countFragments)};
  captures_.impl().captureFrame(*snapshot, work);
}

FrameStats SharedSequence::show(std::size_t technique) {
  if (finalPasses_.empty()) return ofSingle_;
  return showShared(*finalPasses_[technique]);
}

FrameStats SharedSequence::showShared(FinalPass& own) {
  RasterSequence::Impl& shared = captures_.impl();
  shared.device.context.makeCurrent();
  const Snapshot& snapshot = own.layout.apply(*snapshot_);
  assert(!castsShadows(snapshot));
  const FinalImage& image = *shared.image;
  FrameWork work{.fragmentCount = shared.fragmentCount(countFragments_)};
  own.pass.beginFrame(snapshot, {finalPass(snapshot, image.widthSamples(), image.heightSamples())},
                      shared.captures->resolutions());
  work.counted([&] { own.pass.draw(kFinalPass, image.target(), shared.captures->shown(), work.counters); });
  shared.device.context.check("rendering a frame from shared captures");
  work.counters += shared.captures->countersOf(own.technique.bounces);
  work.counters.probeBytes = shared.captures->bytesOf(own.technique, snapshot);
  return {.counters = work.counters,
          .faceAgeFrames = shared.captures->faceAges(),
          .coats = coatSources(own.technique, snapshot),
          .mirrors = mirrorSources(own.technique, snapshot)};
}

}  // namespace pb
