#include "raster/bounce_iterations.h"

#include <algorithm>

#include "raster/captured_faces.h"
#include "raster/frame_passes.h"

namespace pb {
namespace {

// Faces that are ordered by probe, one group a probe.
std::vector<std::vector<ProbeFace>> byProbe(const std::vector<ProbeFace>& faces) {
  std::vector<std::vector<ProbeFace>> groups;
  for (const ProbeFace& f : faces) {
    if (groups.empty() || groups.back().front().probe != f.probe) groups.emplace_back();
    groups.back().push_back(f);
  }
  return groups;
}

}  // namespace

void filterLevels(ProbeMaps& maps, const std::vector<bool>& wanted, FrameWork& work) {
  if (!maps.isStale(wanted)) return;
  work.times.prefilterMs += work.timed([&] { work.counters.texelsFiltered += maps.filter(wanted); });
}

BounceIterations::BounceIterations(RasterDevice::Impl& device, const Technique& technique, ScenePass& scenePass,
                                   ProbeMaps& maps, int probes)
    : device_(device), technique_(technique), scenePass_(scenePass), maps_(maps) {
  if (technique.hysteresis > 0.0f) history_.emplace(device.context, device.programs, technique.hysteresis);
  makeRecords(static_cast<std::size_t>(probes));
}

void BounceIterations::makeRecords(std::size_t probes) {
  if (!repeatsLookups(technique_) || !lookupRecordsFit(device_.limits, technique_.resolution)) return;
  records_.reset();  // first, so that both needn't fit
  records_.emplace(device_.context, device_.programs, device_.limits, technique_, technique_.resolution,
                   static_cast<int>(probes));
  maps_.setFurtherColors(records_->targets());
}

// Records are of one frame only.
void BounceIterations::reorder(const std::vector<int>& before) {
  if (history_) history_->reorder(before);
  if (before.size() != redo_.size()) makeRecords(before.size());
}

void BounceIterations::run(const std::vector<ProbeFace>& due, std::vector<bool>& shown, const std::vector<bool>& levels,
                           FrameWork& work) {
  begin(due, shown.size());
  Run run{shown, levels, work};
  for (int b = 1; b <= technique_.bounces; ++b) {
    run.isLast = b == technique_.bounces;
    work.counted([&] { iterate(due, run); });
    work.afterIteration.push_back(work.counters);
  }
}

void BounceIterations::begin(const std::vector<ProbeFace>& due, std::size_t probes) {
  redo_.assign(probes, {});
  states_.assign(probes, MapState::settled);
  for (const ProbeFace& f : due) {
    redoOf(f) = Redo::everything;
    states_[static_cast<std::size_t>(f.probe)] = MapState::unsettled;
  }
  if (records_) records_->beginFrame(scenePass_.lookupGroups());
}

// The maps that lookups see next are filtered as soon as they are published.
void BounceIterations::iterate(const std::vector<ProbeFace>& due, Run& run) {
  using Groups = std::vector<std::vector<ProbeFace>>;
  double& captureMs = run.work.times.captureMs.emplace_back(0.0);
  for (const auto& faces : technique_.bounceOrder == BounceOrder::simultaneous ? Groups{due} : byProbe(due)) {
    captureMs += run.work.timed([&] { capture(faces, run); });
    filterLevels(maps_, run.levels, run.work);
  }
}

// Brings the faces' captures up to date and publishes what changed.
void BounceIterations::capture(const std::vector<ProbeFace>& faces, Run& run) {
  const std::vector<ProbeFace> repeated = facesTo(Redo::lookups, faces);
  std::vector<ProbeFace> changed = facesTo(Redo::everything, faces);
  const float largestRadiance = texelFormat(technique_.format).largestRadiance;
  const auto bindMirror = [&](const LookupGroup& group) { scenePass_.bindMirror(group); };
  for (const auto& ofProbe : byProbe(repeated))
    records_->repeat(ofProbe.front().probe, maps_, states_, largestRadiance, run.isLast, bindMirror);
  for (const auto& ofProbe : byProbe(changed)) drawProbe(ofProbe, run);
  changed.insert(changed.end(), repeated.begin(), repeated.end());
  publish(changed, run);
}

std::vector<ProbeFace> BounceIterations::facesTo(Redo what, const std::vector<ProbeFace>& faces) const {
  std::vector<ProbeFace> result;
  for (const ProbeFace& f : faces)
    if (redo_[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)] == what) result.push_back(f);
  return result;
}

ShownProbes BounceIterations::shownProbes(int hidden, const Run& run) const {
  return {.maps = &maps_, .shown = run.shown, .hidden = hidden, .states = &states_};
}

// Faces of one probe.
void BounceIterations::drawProbe(const std::vector<ProbeFace>& faces, Run& run) {
  const std::vector<CaptureLookups> lookups =
      records_ && !run.isLast ? planProbe(faces, run) : std::vector<CaptureLookups>(faces.size());
  run.work.counters.facesCaptured += static_cast<std::int64_t>(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const ProbeFace& f = faces[i];
    const bool isRecorded = redoOf(f) == Redo::lookups;
    if (isRecorded) records_->beginCapture();
    const RenderTarget target = isRecorded ? maps_.recordingTarget(f, records_->mirrors(f.probe)) : maps_.target(f);
    scenePass_.draw(capturePass(f), target, shownProbes(f.probe, run), run.work.counters,
                    capturedPart(technique_, f.face), isRecorded ? &*records_ : nullptr);
    if (isRecorded) records_->endCapture(f, lookups[i], maps_.drawn(f.probe));
    if (history_) history_->blend(f, target, maps_.drawn(f.probe), run.isLast);
  }
  if (records_) records_->endProbe(faces.front().probe, maps_.drawn(faces.front().probe));
}

// Decides what later iterations redo of the faces of one probe, which are about to be drawn. Their lookups are recorded
// once a frame: when all maps that they look up are shown.
std::vector<CaptureLookups> BounceIterations::planProbe(const std::vector<ProbeFace>& faces, const Run& run) {
  const int probe = faces.front().probe;
  std::vector<CaptureLookups> lookups;
  std::vector<std::int64_t> texels(scenePass_.lookupGroups().size(), 0);
  bool areShown = true;
  for (const ProbeFace& f : faces) {
    const CaptureLookups& ofFace = lookups.emplace_back(
        scenePass_.lookupsOf(capturePass(f), shownProbes(probe, run), capturedPart(technique_, f.face)));
    areShown = areShown && ofFace.areShown;
    for (std::size_t g = 0; ofFace.isRecordable && g < texels.size(); ++g) texels[g] += ofFace.areas[g].texels();
  }
  const bool areRecorded = std::ranges::count(redo_[static_cast<std::size_t>(probe)], Redo::lookups) == 0 && areShown &&
                           records_->reserve(probe, texels);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Redo& what = redoOf(faces[i]);
    if (!lookups[i].any)
      what = Redo::nothing;
    else if (areRecorded && lookups[i].isRecordable)
      what = Redo::lookups;
  }
  return lookups;
}

void BounceIterations::publish(const std::vector<ProbeFace>& faces, Run& run) {
  if (faces.empty()) return;
  run.work.counters.texelsFiltered += maps_.publish(faces);
  for (const ProbeFace& f : faces) {
    const auto probe = static_cast<std::size_t>(f.probe);
    run.shown[probe] = true;
    const bool isDrawnAgain = std::ranges::count(redo_[probe], Redo::everything) > 0;
    states_[probe] = isDrawnAgain ? MapState::unsettled : MapState::changes;
  }
}

}  // namespace pb
