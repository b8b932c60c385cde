#include "raster/renderer.h"

#include <algorithm>
#include <utility>

#include "raster/frame_passes.h"
#include "raster/lookup.h"
#include "raster/sequence_impl.h"
#include "scenes/error.h"

namespace pb {

FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  facesCaptured += other.facesCaptured;
  draws += other.draws;
  triangles += other.triangles;
  fragments += other.fragments;
  probeBytes = std::max(probeBytes, other.probeBytes);
  texelsFiltered += other.texelsFiltered;
  return *this;
}

FrameCounters& FrameCounters::operator-=(const FrameCounters& other) {
  facesCaptured -= other.facesCaptured;
  draws -= other.draws;
  triangles -= other.triangles;
  fragments -= other.fragments;
  texelsFiltered -= other.texelsFiltered;
  return *this;
}

void checkSettings(const Technique& technique) {
  checkLookup(technique.lookup);
  refreshPolicy(technique.refresh);  // refuses a bad one
  fresnelLaw(technique.fresnel);
  if (technique.bounces < 1) throwInputError("a frame has at least one bounce iteration, got {}", technique.bounces);
}

RasterSequence::Impl::Impl(RasterDevice::Impl& device_, const Technique& technique_, int widthPx, int heightPx,
                           int samplesPerAxis)
    : device(device_),
      programs(device_.programs),
      technique(device_.fault.techniqueOf(technique_)),
      layout(technique_) {
  checkSettings(technique);
  checkImageFits(device.limits, widthPx, heightPx, samplesPerAxis);
  device.context.makeCurrent();
  scenePass.emplace(device, technique);
  captures.emplace(device, technique, *scenePass, widthPx, heightPx, samplesPerAxis);
  image.emplace(device.context, widthPx, heightPx, samplesPerAxis);
}

FrameStats RasterSequence::Impl::renderFrame(const Snapshot& sceneSnapshot, FrameWork& work) {
  device.context.makeCurrent();
  const Snapshot& snapshot = layout.apply(sceneSnapshot);
  capture(snapshot, work);
  work.counted([&] {
    drawMirroredViews(snapshot, work);
    drawFinalImage(work);
  });
  device.context.check("rendering a frame");
  captures->endFrame();
  return {.counters = work.counters,
          .faceAgeFrames = captures->faceAges(),
          .coats = coatSources(technique, snapshot),
          .mirrors = mirrorSources(technique, snapshot)};
}

void RasterSequence::Impl::captureFrame(const Snapshot& sceneSnapshot, FrameWork& work) {
  device.context.makeCurrent();
  capture(layout.apply(sceneSnapshot), work);
  device.context.check("capturing a frame's probes");
  captures->endFrame();
}

const gl::Functions* RasterSequence::Impl::fragmentCount(bool isWanted) {
  return isWanted ? &device.context.functions() : nullptr;
}

void RasterSequence::Impl::capture(const Snapshot& snapshot, FrameWork& work) {
  mirrors = mirroredViews(technique, snapshot);
  captures->beginFrame(snapshot);
  const std::vector<gpu::PassConstants> passes = passesOf(snapshot);
  firstMirroredPass = passes.size() - mirrors.size();
  scenePass->beginFrame(snapshot, passes, captures->resolutions());

  work.counters.probeBytes = mirroredViewBytes(mirrors.size(), image->widthSamples(), image->heightSamples());
  work.counted([&] { work.times.shadowMs = work.timed([&] { scenePass->drawShadows(work.counters); }); });
  captures->capture(work);
}

std::vector<gpu::PassConstants> RasterSequence::Impl::passesOf(const Snapshot& snapshot) const {
  const int width = image->widthSamples(), height = image->heightSamples();
  std::vector<gpu::PassConstants> passes = {finalPass(snapshot, width, height)};
  const std::vector<gpu::PassConstants> ofProbes = captures->passes();
  passes.insert(passes.end(), ofProbes.begin(), ofProbes.end());
  for (const MirroredView& mirror : mirrors) passes.push_back(mirroredPass(snapshot, mirror, width, height));
  return passes;
}

// The views of planar reflectors, which see the newest maps.
void RasterSequence::Impl::drawMirroredViews(const Snapshot& snapshot, FrameWork& work) {
  if (mirrors.empty()) return;
  if (!mirrorImages) mirrorImages.emplace(device.context, image->widthSamples(), image->heightSamples());
  mirrorImages->reserve(mirrors.size());
  mirrorImageOfInstance.assign(snapshot.instances.size(), 0);
  if (work.times.captureMs.empty()) work.times.captureMs.push_back(0.0);
  work.times.captureMs.back() += work.timed([&] {
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      scenePass->draw(firstMirroredPass + i, mirrorImages->target(i), captures->shown(), work.counters);
      ++work.counters.facesCaptured;
      for (const int instance : mirrors[i].instances)
        mirrorImageOfInstance[static_cast<std::size_t>(instance)] = mirrorImages->image(i);
    }
  });
}

void RasterSequence::Impl::drawFinalImage(FrameWork& work) {
  ShownProbes shown = captures->shown();
  shown.mirroredViews = mirrors.empty() ? nullptr : &mirrorImageOfInstance;
  work.times.finalMs = work.timed([&] { scenePass->draw(kFinalPass, image->target(), shown, work.counters); });
}

void RasterSequence::check(RasterDevice& device, const Technique& technique, const Snapshot& snapshot, int widthPx,
                           int heightPx, int samplesPerAxis) {
  ProbeLayout layout(technique);
  const Snapshot& placed = layout.apply(snapshot);
  mirroredViews(technique, placed);
  const ProbeFilter levels = levelFilter(technique, placed);
  checkMaps(technique, levels);
  checkProbesFit(device.impl().limits, technique, static_cast<int>(placed.probes.size()), levels, widthPx, heightPx,
                 samplesPerAxis);
}

RasterSequence::RasterSequence(RasterDevice& device, const Technique& technique, int widthPx, int heightPx,
                               int samplesPerAxis)
    : impl_(std::make_unique<Impl>(device.impl(), technique, widthPx, heightPx, samplesPerAxis)) {}
RasterSequence::~RasterSequence() = default;

FrameStats RasterSequence::renderFrame(const Snapshot& snapshot, bool countFragments) {
  FrameWork work{.fragmentCount = impl_->fragmentCount(countFragments)};
  return impl_->renderFrame(snapshot, work);
}

PassTimes RasterSequence::renderFrameTimed(const Snapshot& snapshot) {
  impl_->device.context.makeCurrent();
  if (!impl_->timer) impl_->timer.emplace(impl_->device.context.functions(), impl_->device.info.software);
  FrameWork work{.timer = &*impl_->timer};
  impl_->renderFrame(snapshot, work);
  return work.times;
}

void RasterSequence::finish() {
  impl_->device.context.makeCurrent();
  impl_->device.context.functions().Finish();
  impl_->device.context.check("finishing a frame");
}

Image RasterSequence::readImage() {
  impl_->device.context.makeCurrent();
  Image image = impl_->image->read();
  impl_->device.context.check("reading the image");
  return image;
}

Grid<SampleId> RasterSequence::renderIds(const Snapshot& snapshot) {
  gl::Context& context = impl_->device.context;
  context.makeCurrent();
  IdImage ids(context, impl_->image->widthSamples(), impl_->image->heightSamples());
  // The scene's own instances, without the technique's probes.
  const std::vector<int> resolutions(snapshot.probes.size(), impl_->technique.resolution);
  const FinalImage& image = *impl_->image;
  impl_->scenePass->beginFrame(snapshot, {finalPass(snapshot, image.widthSamples(), image.heightSamples())},
                               resolutions);
  impl_->scenePass->drawIds(kFinalPass, ids.target());
  Grid<SampleId> result = ids.read();
  context.check("rendering ids");
  return result;
}

void RasterSequence::setProbe(int probe, const std::array<Image, 6>& faces, const std::array<Plane, 6>& distances) {
  impl_->captures->give(probe, {faces, distances});
}

std::array<Image, 6> RasterSequence::readProbe(int probe, int level) {
  impl_->device.context.makeCurrent();
  std::array<Image, 6> faces = impl_->captures->read(probe, level);
  impl_->device.context.check("reading a cube map");
  return faces;
}

std::array<Plane, 6> RasterSequence::readProbeDistances(int probe) {
  impl_->device.context.makeCurrent();
  std::array<Plane, 6> faces = impl_->captures->readDistances(probe);
  impl_->device.context.check("reading distances of a cube map");
  return faces;
}

}  // namespace pb
