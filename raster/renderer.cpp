#include "raster/renderer.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "raster/capture_history.h"
#include "raster/captured_faces.h"
#include "raster/device.h"
#include "raster/final_image.h"
#include "raster/lookup.h"
#include "raster/lookup_records.h"
#include "raster/pass_timer.h"
#include "raster/planar.h"
#include "raster/planar_images.h"
#include "raster/probe_layout.h"
#include "raster/probe_maps.h"
#include "raster/probe_resolution.h"
#include "raster/proxy.h"
#include "raster/reflection.h"
#include "raster/refresh/policies.h"
#include "raster/scene_pass.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr float kLargestHalf = 65504.0f;
constexpr float kUnlimited = std::numeric_limits<float>::infinity();

// Passes of a frame by number: the final image, then the faces of the probes.
constexpr std::size_t kFinalPass = 0;
std::size_t capturePass(const ProbeFace& f) { return 1 + static_cast<std::size_t>(6 * f.probe + f.face); }

gpu::PassConstants passConstants(const Snapshot& snapshot, const shading::View& view, int width, int height,
                                 float largestRadiance) {
  return {.view = withResolution(view, width),
          .image = {static_cast<float>(width), static_cast<float>(height), largestRadiance, 0.0f},
          .lights = {static_cast<float>(snapshot.lights.size()), static_cast<float>(snapshot.areaLights.size()), 0.0f,
                     0.0f},
          .clip = glm::vec4(0.0f)};
}

// A single view stands for all faces of a probe.
std::vector<ProbeFace> oneFaceEach(std::vector<ProbeFace> faces) {
  const auto isSameProbe = [](const ProbeFace& a, const ProbeFace& b) { return a.probe == b.probe; };
  faces.erase(std::unique(faces.begin(), faces.end(), isSameProbe), faces.end());
  for (ProbeFace& f : faces) f.face = 0;
  return faces;
}

// PassConstants::clip of a capture that shows nothing farther than that along the axis of its face; 0: everything.
glm::vec4 farPlane(const shading::View& view, float metres) {
  if (metres <= 0.0f) return glm::vec4(0.0f);
  const glm::vec3 forward(view.forward);
  return {-forward, metres + glm::dot(forward, glm::vec3(view.origin))};
}

// Faces that are ordered by probe, one group a probe.
std::vector<std::vector<ProbeFace>> byProbe(const std::vector<ProbeFace>& faces) {
  std::vector<std::vector<ProbeFace>> groups;
  for (const ProbeFace& f : faces) {
    if (groups.empty() || groups.back().front().probe != f.probe) groups.emplace_back();
    groups.back().push_back(f);
  }
  return groups;
}

// The time of a pass; 0 without a timer.
template <class Pass>
double timed(PassTimer* timer, const Pass& pass) {
  if (timer != nullptr) timer->start();
  pass();
  return timer != nullptr ? timer->stopMs() : 0.0;
}

}  // namespace

FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  facesCaptured += other.facesCaptured;
  draws += other.draws;
  triangles += other.triangles;
  fragments += other.fragments;
  probeBytes = std::max(probeBytes, other.probeBytes);
  texelsFiltered += other.texelsFiltered;
  return *this;
}

struct RasterSequence::Impl {
  Impl(RasterDevice::Impl& device_, const Technique& technique_, int widthPx_, int heightPx_, int samplesPerAxis_);
  ~Impl() { device.context.makeCurrent(); }  // the members free GL objects

  // What later bounce iterations have to do for a face's capture to be that of brute force.
  enum class Redo { nothing, lookups, everything };

  struct Frame {
    FrameStats stats;
    PassTimes times;
  };
  Frame renderFrame(const Snapshot& sceneSnapshot, PassTimer* passTimer);

  bool isDynamic() const { return technique.probes == ProbeUse::dynamic && capturesMaps; }
  ShownProbes shownProbes(int hidden) const {
    return {.maps = probes ? &*probes : nullptr, .shown = mapShown, .hidden = hidden, .states = &mapStates};
  }
  void allocateProbes(const Snapshot& snapshot);
  void resizeProbes(const Snapshot& snapshot);
  gpu::PassConstants finalPass(const Snapshot& snapshot) const;
  std::vector<gpu::PassConstants> passesOf(const Snapshot& snapshot) const;
  void appendCapturePasses(const Snapshot& snapshot, std::vector<gpu::PassConstants>& passes) const;
  std::vector<bool> mapsShownAtFirst(const std::vector<ProbeFace>& due, std::size_t probeCount) const;
  void fillMissingFaces(const Snapshot& snapshot, FrameCounters& counters);
  void iterate(const std::vector<ProbeFace>& due, bool isLast, PassTimer* passTimer, Frame& frame);
  void updateLevels(PassTimer* passTimer, Frame& frame);
  void beginIterations(const std::vector<ProbeFace>& due, std::size_t probeCount);
  void capture(const std::vector<ProbeFace>& faces, bool isLast, FrameCounters& counters);
  std::vector<ProbeFace> facesTo(Redo what, const std::vector<ProbeFace>& faces) const;
  void drawProbe(const std::vector<ProbeFace>& faces, bool isLast, FrameCounters& counters);
  std::vector<CaptureLookups> planProbe(const std::vector<ProbeFace>& faces);
  void publish(const std::vector<ProbeFace>& faces, FrameCounters& counters);
  Redo& redoOf(const ProbeFace& f) { return redo[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)]; }
  void drawMirroredViews(const Snapshot& snapshot, PassTimer* passTimer, Frame& frame);
  std::size_t passesBeforeMirrors(const Snapshot& snapshot) const;
  std::vector<std::array<std::int64_t, 6>> faceAges() const;

  RasterDevice::Impl& device;
  const Technique technique;
  const int widthPx;
  const int heightPx;
  const int samplesPerAxis;
  std::optional<ScenePass> scenePass;
  std::optional<FinalImage> image;
  std::optional<ProbeMaps> probes;
  std::vector<int> resolutions;                  // by probe, of this frame
  std::optional<CaptureHistory> captureHistory;  // with hysteresis
  std::optional<PassTimer> timer;
  ProbeLayout layout;
  RefreshHistory history;
  std::vector<MirroredView> mirrors;  // of this frame
  std::optional<PlanarImages> mirrorImages;
  std::vector<GLuint> mirrorImageOfInstance;  // by instance: 0 for those that show none
  bool capturesMaps = true;                   // something looks the maps of probes up
  std::vector<std::size_t> filled;  // by probe: 1 + the environment that faces show which are never captured; 0: none
  std::vector<bool> mapShown;       // by probe: lookups read its cube map, not the environment
  std::vector<bool> levelsShown;    // by probe: lookups read its filtered levels
  std::optional<LookupRecords> records;   // of techniques that repeat lookups
  std::vector<std::array<Redo, 6>> redo;  // by probe
  std::vector<MapState> mapStates;        // by probe
};

RasterSequence::Impl::Impl(RasterDevice::Impl& device_, const Technique& technique_, int widthPx_, int heightPx_,
                           int samplesPerAxis_)
    : device(device_),
      technique(technique_),
      widthPx(widthPx_),
      heightPx(heightPx_),
      samplesPerAxis(samplesPerAxis_),
      layout(technique_) {
  history.technique = technique;
  checkLookup(technique.lookup);
  refreshPolicy(technique.refresh);  // refuses a bad one
  fresnelLaw(technique.fresnel);
  if (technique.bounces < 1) throwInputError("a frame has at least one bounce iteration, got {}", technique.bounces);
  checkImageFits(device.limits, widthPx, heightPx, samplesPerAxis);
  checkProbesFit(device.limits, technique, 1, ProbeFilter::none, widthPx, heightPx, samplesPerAxis);
  device.context.makeCurrent();
  scenePass.emplace(device, technique);
  image.emplace(device.context, widthPx, heightPx, samplesPerAxis);
}

RasterSequence::Impl::Frame RasterSequence::Impl::renderFrame(const Snapshot& sceneSnapshot, PassTimer* passTimer) {
  device.context.makeCurrent();
  const Snapshot& snapshot = layout.apply(sceneSnapshot);
  mirrors = mirroredViews(technique, snapshot);
  capturesMaps = looksUpMaps(technique, snapshot);
  allocateProbes(snapshot);
  resizeProbes(snapshot);
  const std::vector<ProbeFace> due =
      isDynamic() ? dueFaces(technique.refresh, history, snapshot) : std::vector<ProbeFace>{};
  mapShown = mapsShownAtFirst(due, snapshot.probes.size());
  levelsShown = probesWithLevels(technique, snapshot);
  scenePass->beginFrame(snapshot, passesOf(snapshot), resolutions);

  Frame frame;
  FrameCounters& counters = frame.stats.counters;
  if (isDynamic()) counters.probeBytes = probeBytes(technique, resolutions, levelFilter(technique, snapshot));
  counters.probeBytes += mirroredViewBytes(mirrors.size(), image->widthSamples(), image->heightSamples());
  frame.times.shadowMs = timed(passTimer, [&] { scenePass->drawShadows(counters); });
  updateLevels(passTimer, frame);  // of probes that rough lobes look up for the first time
  const std::vector<ProbeFace> captured = viewsOfProbe(technique) == 1 ? oneFaceEach(due) : due;
  if (probes && viewsOfProbe(technique) > 1) fillMissingFaces(snapshot, counters);
  beginIterations(captured, snapshot.probes.size());
  for (int b = 0; isDynamic() && b < technique.bounces; ++b)
    iterate(captured, b + 1 == technique.bounces, passTimer, frame);
  if (records) counters.probeBytes += records->bytes();
  updateLevels(passTimer, frame);  // of maps in which nothing but the environment has changed
  drawMirroredViews(snapshot, passTimer, frame);
  ShownProbes shown = shownProbes(kNoProbe);
  shown.mirroredViews = mirrors.empty() ? nullptr : &mirrorImageOfInstance;
  frame.times.finalMs = timed(passTimer, [&] { scenePass->draw(kFinalPass, image->target(), shown, counters); });
  device.context.check("rendering a frame");

  advance(history, due, snapshot);
  frame.stats.faceAgeFrames = faceAges();
  frame.stats.coats = coatSources(technique, snapshot);
  return frame;
}

void RasterSequence::Impl::allocateProbes(const Snapshot& snapshot) {
  assert(history.frame == 0 || history.lastCapturedFrame.size() == snapshot.probes.size());
  if (!isDynamic() || probes || snapshot.probes.empty()) return;
  const int count = static_cast<int>(snapshot.probes.size());
  const ProbeFilter levels = levelFilter(technique, snapshot);
  checkMaps(technique, levels);
  checkProbesFit(device.limits, technique, count, levels, widthPx, heightPx, samplesPerAxis);
  if (technique.hysteresis > 0.0f) captureHistory.emplace(device.context, device.programs, technique.hysteresis);
  resolutions = probeResolutions(technique, snapshot, heightPx);
  probes.emplace(device.context, device.programs,
                 ProbeMaps::Settings{.resolutions = resolutions,
                                     .largest = technique.resolution,
                                     .views = viewsOfProbe(technique),
                                     .doubleBuffered = technique.bounceOrder == BounceOrder::simultaneous,
                                     .filter = levels,
                                     .keepsDistances = needsDistances(technique),
                                     .format = technique.format,
                                     .storage = technique.storage,
                                     .seamless = technique.seamless});
  if (!repeatsLookups(technique) || !lookupRecordsFit(device.limits, technique.resolution)) return;
  records.emplace(device.context, device.programs, device.limits, technique, technique.resolution, count);
  probes->setFurtherColors(records->targets());
}

// Probes whose resolution changes are due with all of their faces, and show until then what they showed before.
void RasterSequence::Impl::resizeProbes(const Snapshot& snapshot) {
  const std::vector<int> wanted = probeResolutions(technique, snapshot, heightPx);
  for (std::size_t probe = 0; probes && probe < wanted.size(); ++probe) {
    if (resolutions[probe] == wanted[probe]) continue;
    probes->resize(static_cast<int>(probe), wanted[probe]);
    history.lastCapturedFrame[probe].fill(-1);
    if (probe < filled.size()) filled[probe] = 0;
  }
  resolutions = wanted;
}

gpu::PassConstants RasterSequence::Impl::finalPass(const Snapshot& snapshot) const {
  return passConstants(snapshot, snapshot.camera, image->widthSamples(), image->heightSamples(), kUnlimited);
}

std::vector<gpu::PassConstants> RasterSequence::Impl::passesOf(const Snapshot& snapshot) const {
  std::vector<gpu::PassConstants> passes = {finalPass(snapshot)};
  if (probes) appendCapturePasses(snapshot, passes);
  for (const MirroredView& mirror : mirrors) {
    passes.push_back(passConstants(snapshot, mirror.view, image->widthSamples(), image->heightSamples(), kLargestHalf));
    passes.back().clip = {mirror.plane.normal, -mirror.plane.offset};
  }
  return passes;
}

void RasterSequence::Impl::appendCapturePasses(const Snapshot& snapshot,
                                               std::vector<gpu::PassConstants>& passes) const {
  const bool isSingleView = viewsOfProbe(technique) == 1;
  for (const ProbeFace& f : allFaces(snapshot)) {
    const Probe& probe = snapshot.probes[static_cast<std::size_t>(f.probe)];
    const shading::View view =
        isSingleView ? singleView(snapshot, probe) : cubeFaceView(probe.position, f.face, probe.zNear);
    const int resolution = resolutions[static_cast<std::size_t>(f.probe)];
    passes.push_back(
        passConstants(snapshot, view, resolution, resolution, texelFormat(technique.format).largestRadiance));
    passes.back().clip = farPlane(view, technique.captureFar);
  }
}

// What lookups read before the frame's first capture: maps that are complete, unless the technique wants probes that
// are due to show the environment.
std::vector<bool> RasterSequence::Impl::mapsShownAtFirst(const std::vector<ProbeFace>& due,
                                                         std::size_t probeCount) const {
  std::vector<bool> shown(probeCount, isDynamic() && history.frame > 0);
  if (technique.feedback == Feedback::sky)
    for (const ProbeFace& f : due) shown[static_cast<std::size_t>(f.probe)] = false;
  return shown;
}

// Faces that are never captured show the environment of the snapshot's time.
void RasterSequence::Impl::fillMissingFaces(const Snapshot& snapshot, FrameCounters& counters) {
  filled.resize(snapshot.probes.size(), 0);
  std::vector<ProbeFace> missing = allFaces(snapshot);
  std::erase_if(missing, [&](const ProbeFace& f) {
    return capturedPart(technique, f.face) != FacePart::nothing ||
           filled[static_cast<std::size_t>(f.probe)] == snapshot.environmentIndex + 1;
  });
  for (const ProbeFace& f : missing) {
    scenePass->draw(capturePass(f), probes->target(f), shownProbes(f.probe), counters, FacePart::nothing);
    filled[static_cast<std::size_t>(f.probe)] = snapshot.environmentIndex + 1;
  }
  if (!missing.empty()) counters.texelsFiltered += probes->publish(missing);
}

// One bounce iteration. The maps that lookups see next are filtered as soon as they are published.
void RasterSequence::Impl::iterate(const std::vector<ProbeFace>& due, bool isLast, PassTimer* passTimer, Frame& frame) {
  using Groups = std::vector<std::vector<ProbeFace>>;
  double& captureMs = frame.times.captureMs.emplace_back(0.0);
  for (const auto& faces : technique.bounceOrder == BounceOrder::simultaneous ? Groups{due} : byProbe(due)) {
    captureMs += timed(passTimer, [&] { capture(faces, isLast, frame.stats.counters); });
    updateLevels(passTimer, frame);
  }
}

void RasterSequence::Impl::updateLevels(PassTimer* passTimer, Frame& frame) {
  if (!probes || !probes->isStale(levelsShown)) return;
  frame.times.prefilterMs +=
      timed(passTimer, [&] { frame.stats.counters.texelsFiltered += probes->filter(levelsShown); });
}

void RasterSequence::Impl::beginIterations(const std::vector<ProbeFace>& due, std::size_t probeCount) {
  redo.assign(probeCount, {});
  mapStates.assign(probeCount, MapState::settled);
  for (const ProbeFace& f : due) {
    redoOf(f) = Redo::everything;
    mapStates[static_cast<std::size_t>(f.probe)] = MapState::unsettled;
  }
  if (records) records->beginFrame();
}

// Brings the faces' captures up to date and publishes what changed.
void RasterSequence::Impl::capture(const std::vector<ProbeFace>& faces, bool isLast, FrameCounters& counters) {
  const std::vector<ProbeFace> repeated = facesTo(Redo::lookups, faces);
  std::vector<ProbeFace> changed = facesTo(Redo::everything, faces);
  for (const auto& ofProbe : byProbe(repeated))
    records->repeat(ofProbe.front().probe, *probes, mapStates, kLargestHalf, isLast);
  for (const auto& ofProbe : byProbe(changed)) drawProbe(ofProbe, isLast, counters);
  changed.insert(changed.end(), repeated.begin(), repeated.end());
  publish(changed, counters);
}

std::vector<ProbeFace> RasterSequence::Impl::facesTo(Redo what, const std::vector<ProbeFace>& faces) const {
  std::vector<ProbeFace> result;
  for (const ProbeFace& f : faces)
    if (redo[static_cast<std::size_t>(f.probe)][static_cast<std::size_t>(f.face)] == what) result.push_back(f);
  return result;
}

// Faces of one probe.
void RasterSequence::Impl::drawProbe(const std::vector<ProbeFace>& faces, bool isLast, FrameCounters& counters) {
  const std::vector<CaptureLookups> lookups =
      records && !isLast ? planProbe(faces) : std::vector<CaptureLookups>(faces.size());
  counters.facesCaptured += static_cast<std::int64_t>(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const ProbeFace& f = faces[i];
    const bool isRecorded = redoOf(f) == Redo::lookups;
    if (isRecorded) records->beginCapture();
    const RenderTarget target = isRecorded ? probes->recordingTarget(f) : probes->target(f);
    scenePass->draw(capturePass(f), target, shownProbes(f.probe), counters, capturedPart(technique, f.face),
                    isRecorded ? &*records : nullptr);
    if (isRecorded) records->endCapture(f, lookups[i]);
    if (captureHistory) captureHistory->blend(f, target, probes->captured(f.probe), isLast);
  }
}

// Decides what later iterations redo of the faces of one probe, which are about to be drawn. Their lookups are recorded
// once a frame: when all maps that they look up are shown.
std::vector<CaptureLookups> RasterSequence::Impl::planProbe(const std::vector<ProbeFace>& faces) {
  const int probe = faces.front().probe;
  std::vector<CaptureLookups> lookups;
  std::vector<std::int64_t> texels(mapShown.size(), 0);
  bool areShown = true;
  for (const ProbeFace& f : faces) {
    const CaptureLookups& ofFace =
        lookups.emplace_back(scenePass->lookupsOf(capturePass(f), shownProbes(probe), capturedPart(technique, f.face)));
    areShown = areShown && ofFace.areShown;
    for (std::size_t p = 0; ofFace.isRecordable && p < texels.size(); ++p) texels[p] += ofFace.areas[p].texels();
  }
  const bool areRecorded = std::ranges::count(redo[static_cast<std::size_t>(probe)], Redo::lookups) == 0 && areShown &&
                           records->reserve(probe, texels);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Redo& what = redoOf(faces[i]);
    if (!lookups[i].any)
      what = Redo::nothing;
    else if (areRecorded && lookups[i].isRecordable)
      what = Redo::lookups;
  }
  return lookups;
}

void RasterSequence::Impl::publish(const std::vector<ProbeFace>& faces, FrameCounters& counters) {
  if (faces.empty()) return;
  counters.texelsFiltered += probes->publish(faces);
  for (const ProbeFace& f : faces) {
    const auto probe = static_cast<std::size_t>(f.probe);
    mapShown[probe] = true;
    const bool isDrawnAgain = std::ranges::count(redo[probe], Redo::everything) > 0;
    mapStates[probe] = isDrawnAgain ? MapState::unsettled : MapState::changes;
  }
}

// The views of planar reflectors, which see the newest maps.
void RasterSequence::Impl::drawMirroredViews(const Snapshot& snapshot, PassTimer* passTimer, Frame& frame) {
  if (mirrors.empty()) return;
  if (!mirrorImages) mirrorImages.emplace(device.context, image->widthSamples(), image->heightSamples());
  mirrorImages->reserve(mirrors.size());
  mirrorImageOfInstance.assign(snapshot.instances.size(), 0);
  if (frame.times.captureMs.empty()) frame.times.captureMs.push_back(0.0);
  frame.times.captureMs.back() += timed(passTimer, [&] {
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      const std::size_t pass = passesBeforeMirrors(snapshot) + i;
      scenePass->draw(pass, mirrorImages->target(i), shownProbes(kNoProbe), frame.stats.counters);
      ++frame.stats.counters.facesCaptured;
      for (const int instance : mirrors[i].instances)
        mirrorImageOfInstance[static_cast<std::size_t>(instance)] = mirrorImages->image(i);
    }
  });
}

std::size_t RasterSequence::Impl::passesBeforeMirrors(const Snapshot& snapshot) const {
  return 1 + (probes ? 6 * snapshot.probes.size() : 0);
}

std::vector<std::array<std::int64_t, 6>> RasterSequence::Impl::faceAges() const {
  if (!isDynamic()) return {};
  std::vector<std::array<std::int64_t, 6>> ages = history.lastCapturedFrame;
  const std::int64_t rendered = history.frame - 1;
  for (std::array<std::int64_t, 6>& probe : ages)
    for (std::int64_t& age : probe) age = age < 0 ? -1 : rendered - age;
  return ages;
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
  if (!countFragments) return impl_->renderFrame(snapshot, nullptr).stats;
  impl_->device.context.makeCurrent();
  const gl::Functions& gl = impl_->device.context.functions();
  const gl::Query query = gl::makeQuery(gl, GL_SAMPLES_PASSED);
  gl.BeginQuery(GL_SAMPLES_PASSED, query.id());
  FrameStats stats = impl_->renderFrame(snapshot, nullptr).stats;
  gl.EndQuery(GL_SAMPLES_PASSED);
  stats.counters.fragments = static_cast<std::int64_t>(gl::queryResult(query));
  return stats;
}

PassTimes RasterSequence::renderFrameTimed(const Snapshot& snapshot) {
  impl_->device.context.makeCurrent();
  if (!impl_->timer) impl_->timer.emplace(impl_->device.context.functions(), impl_->device.info.software);
  return impl_->renderFrame(snapshot, &*impl_->timer).times;
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
  impl_->scenePass->beginFrame(snapshot, {impl_->finalPass(snapshot)}, resolutions);
  impl_->scenePass->drawIds(kFinalPass, ids.target());
  Grid<SampleId> result = ids.read();
  context.check("rendering ids");
  return result;
}

std::array<Image, 6> RasterSequence::readProbe(int probe, int level) {
  if (!impl_->probes || probe < 0 || static_cast<std::size_t>(probe) >= impl_->mapShown.size())
    throwInputError("the last frame has no cube map of probe {}", probe);
  impl_->device.context.makeCurrent();
  std::array<Image, 6> faces = impl_->probes->read(probe, level);
  impl_->device.context.check("reading a cube map");
  return faces;
}

}  // namespace pb
