#include "raster/probe_captures.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "raster/captured_faces.h"
#include "raster/frame_passes.h"
#include "raster/lookup.h"
#include "raster/probe_resolution.h"
#include "raster/refresh/policies.h"
#include "scenes/error.h"

namespace pb {
namespace {

// A single view stands for all faces of a probe.
std::vector<ProbeFace> oneFaceEach(std::vector<ProbeFace> faces) {
  const auto isSameProbe = [](const ProbeFace& a, const ProbeFace& b) { return a.probe == b.probe; };
  faces.erase(std::unique(faces.begin(), faces.end(), isSameProbe), faces.end());
  for (ProbeFace& f : faces) f.face = 0;
  return faces;
}

}  // namespace

ProbeCaptures::ProbeCaptures(RasterDevice::Impl& device, const Technique& technique, ScenePass& scenePass, int widthPx,
                             int heightPx, int samplesPerAxis)
    : device_(device),
      technique_(technique),
      scenePass_(scenePass),
      widthPx_(widthPx),
      heightPx_(heightPx),
      samplesPerAxis_(samplesPerAxis) {
  history_.technique = technique;
  checkProbesFit(device.limits, technique, 1, ProbeFilter::none, widthPx, heightPx, samplesPerAxis);
  if (technique.probes == ProbeUse::given && viewsOfProbe(technique) == 1)
    throwInputError("the maps of lookup = single-view are no cubes that could be given");
}

void ProbeCaptures::give(int probe, GivenProbe content) {
  if (technique_.probes != ProbeUse::given) throwInputError("probe {} is captured: its map can't be given", probe);
  given_[probe] = std::move(content);
}

void ProbeCaptures::beginFrame(const Snapshot& snapshot) {
  snapshot_ = &snapshot;
  areLookedUp_ = looksUpMaps(technique_, snapshot);
  nears_.clear();
  for (const Probe& probe : snapshot.probes) nears_.push_back(probe.zNear);
  followProbes();
  allocate();
  resize();
  if (technique_.probes == ProbeUse::given) showGiven();
  due_ = isCaptured() ? dueFaces(technique_.refresh, history_, snapshot) : std::vector<ProbeFace>{};
  device_.fault.changeDue(due_, history_.frame);
  shown_ = mapsShownAtFirst();
  levels_ = probesWithLevels(technique_, snapshot);
}

// Probes that are joined with others, or part from them, start anew: no map fits where they stand now.
void ProbeCaptures::followProbes() {
  const std::optional<std::vector<int>> before = probes_.follow(*snapshot_);
  if (!before) return;
  reorder(history_, *before);
  filled_ = reordered(std::move(filled_), *before, std::size_t{0});
  isGiven_ = reordered(std::move(isGiven_), *before, false);
  isComplete_ = reordered(std::move(isComplete_), *before, false);
  if (!maps_) return;
  checkProbesFit(device_.limits, technique_, static_cast<int>(before->size()), levelFilter(technique_, *snapshot_),
                 widthPx_, heightPx_, samplesPerAxis_);
  const std::vector<int> wanted = probeResolutions(technique_, *snapshot_, heightPx_);
  resolutions_ = reordered(std::move(resolutions_), *before, 0);
  for (std::size_t probe = 0; probe < wanted.size(); ++probe)
    if ((*before)[probe] == kNewProbe) resolutions_[probe] = wanted[probe];
  maps_->reorder(*before, resolutions_);
  if (iterations_) iterations_->reorder(*before);
}

void ProbeCaptures::allocate() {
  assert(history_.frame == 0 || history_.lastCapturedFrame.size() == snapshot_->probes.size());
  if (!hasMaps() || maps_ || snapshot_->probes.empty()) return;
  const int count = static_cast<int>(snapshot_->probes.size());
  const ProbeFilter levels = levelFilter(technique_, *snapshot_);
  checkMaps(technique_, levels);
  checkProbesFit(device_.limits, technique_, count, levels, widthPx_, heightPx_, samplesPerAxis_);
  resolutions_ = probeResolutions(technique_, *snapshot_, heightPx_);
  isGiven_.assign(snapshot_->probes.size(), false);
  maps_.emplace(device_.context, device_.programs,
                ProbeMaps::Settings{.resolutions = resolutions_,
                                    .largest = technique_.resolution,
                                    .views = viewsOfProbe(technique_),
                                    .doubleBuffered = technique_.bounceOrder == BounceOrder::simultaneous,
                                    .capturesApart = device_.capturesApart,
                                    .filter = levels,
                                    .keepsDistances = needsDistances(technique_),
                                    .format = technique_.format,
                                    .storage = technique_.storage,
                                    .seamless = technique_.seamless});
  if (isCaptured()) iterations_.emplace(device_, technique_, scenePass_, *maps_, count);
}

// Probes whose resolution changes are due with all of their faces, and show until then what they showed before.
void ProbeCaptures::resize() {
  const std::vector<int> wanted = probeResolutions(technique_, *snapshot_, heightPx_);
  for (std::size_t probe = 0; maps_ && probe < wanted.size(); ++probe) {
    if (resolutions_[probe] == wanted[probe]) continue;
    maps_->resize(static_cast<int>(probe), wanted[probe]);
    history_.lastCapturedFrame[probe].fill(-1);
    isGiven_[probe] = false;
    if (probe < filled_.size()) filled_[probe] = 0;
  }
  resolutions_ = wanted;
}

void ProbeCaptures::showGiven() {
  if (!maps_) return;
  for (const auto& [probe, content] : std::exchange(given_, {})) {
    const auto index = static_cast<std::size_t>(probe);
    if (index >= isGiven_.size())
      throwInputError("probe {} was given a map, there are probes 0 to {}", probe, isGiven_.size() - 1);
    checkGiven(index, content);
    maps_->write(probe, content.faces, content.distances, nears_[index]);
    isGiven_[index] = true;
  }
  if (const auto missing = std::ranges::find(isGiven_, false); missing != isGiven_.end())
    throwInputError("the map of probe {} was not given in {} x {} texels a face", missing - isGiven_.begin(),
                    resolutions_[static_cast<std::size_t>(missing - isGiven_.begin())],
                    resolutions_[static_cast<std::size_t>(missing - isGiven_.begin())]);
}

void ProbeCaptures::checkGiven(std::size_t probe, const GivenProbe& content) const {
  const int n = resolutions_[probe];
  for (const Image& face : content.faces)
    if (face.width() != n || face.height() != n)
      throwInputError("faces of probe {} have {} x {} texels, one of {} x {} was given", probe, n, n, face.width(),
                      face.height());
  if (!needsDistances(technique_)) return;
  for (const Plane& face : content.distances)
    if (face.width() != n || face.height() != n)
      throwInputError("lookup '{}' reads distances: probe {} wants {} x {} of them a face, got {} x {}",
                      printSpec(technique_.lookup), probe, n, n, face.width(), face.height());
}

std::vector<gpu::PassConstants> ProbeCaptures::passes() const {
  if (!iterations_) return {};
  std::vector<gpu::PassConstants> passes = capturePasses(technique_, *snapshot_, resolutions_);
  device_.fault.changePasses(passes);
  return passes;
}

// What lookups read before the frame's first capture: maps that are complete, unless the technique wants probes that
// are about to be captured to show the sky.
std::vector<bool> ProbeCaptures::mapsShownAtFirst() const {
  if (technique_.probes == ProbeUse::given) return std::vector<bool>(snapshot_->probes.size(), maps_.has_value());
  std::vector<bool> shown = isComplete_;
  shown.resize(snapshot_->probes.size(), false);
  if (technique_.feedback == Feedback::sky)
    for (const ProbeFace& f : due_) shown[static_cast<std::size_t>(f.probe)] = false;
  return shown;
}

ShownProbes ProbeCaptures::shown() const { return {.maps = maps_ ? &*maps_ : nullptr, .shown = shown_}; }

void ProbeCaptures::capture(FrameWork& work) {
  before_ = work.counters;
  work.counted([&] { prepare(work); });
  if (iterations_) {
    const PlantedFault::Depth depth(device_.fault, device_.context.functions());
    iterations_->run(viewsOfProbe(technique_) == 1 ? oneFaceEach(due_) : due_, shown_, levels_, work);
    device_.fault.changeMaps(*maps_, due_, nears_);
  } else if (isCaptured()) {
    work.times.captureMs.resize(static_cast<std::size_t>(technique_.bounces), 0.0);
  }
  if (maps_) filterLevels(*maps_, levels_, work);  // of maps in which nothing but the environment has changed
  work.counters.probeBytes += bytesOf(technique_, *snapshot_);
  afterIteration_ = work.afterIteration;
  after_ = work.counters;
}

// What comes before the bounce iterations.
void ProbeCaptures::prepare(FrameWork& work) {
  if (maps_) filterLevels(*maps_, levels_, work);  // of probes that rough lobes look up for the first time
  if (!iterations_ || viewsOfProbe(technique_) == 1) return;
  const PlantedFault::Depth depth(device_.fault, device_.context.functions());
  fillMissingFaces(work);
}

std::int64_t ProbeCaptures::bytesOf(const Technique& technique, const Snapshot& snapshot) const {
  if (!hasMaps()) return 0;
  return probeBytes(technique, resolutions_, levelFilter(technique, snapshot)) +
         (iterations_ ? iterations_->bytes() : 0);
}

// Iterations beyond those of the technique are taken off.
FrameCounters ProbeCaptures::countersOf(int bounces) const {
  FrameCounters counters = after_;
  counters -= before_;
  if (afterIteration_.empty()) return counters;
  counters -= afterIteration_.back();
  counters += afterIteration_[static_cast<std::size_t>(bounces - 1)];
  return counters;
}

// Faces that are never captured show the environment of the snapshot's time.
void ProbeCaptures::fillMissingFaces(FrameWork& work) {
  filled_.resize(snapshot_->probes.size(), 0);
  std::vector<ProbeFace> missing = allFaces(*snapshot_);
  std::erase_if(missing, [&](const ProbeFace& f) {
    return capturedPart(technique_, f.face) != FacePart::nothing ||
           filled_[static_cast<std::size_t>(f.probe)] == snapshot_->environmentIndex + 1;
  });
  for (const ProbeFace& f : missing) {
    ShownProbes shownToFace = shown();
    shownToFace.hidden = f.probe;
    scenePass_.draw(capturePass(f), maps_->target(f), shownToFace, work.counters, FacePart::nothing);
    filled_[static_cast<std::size_t>(f.probe)] = snapshot_->environmentIndex + 1;
  }
  if (!missing.empty()) work.counters.texelsFiltered += maps_->publish(missing);
}

void ProbeCaptures::endFrame() {
  isComplete_.assign(snapshot_->probes.size(), isCaptured());
  advance(history_, due_, *std::exchange(snapshot_, nullptr));
}

std::vector<std::array<std::int64_t, 6>> ProbeCaptures::faceAges() const {
  if (!isCaptured()) return {};
  std::vector<std::array<std::int64_t, 6>> ages = history_.lastCapturedFrame;
  const std::int64_t rendered = history_.frame - 1;
  for (std::array<std::int64_t, 6>& probe : ages)
    for (std::int64_t& age : probe) age = age < 0 ? -1 : rendered - age;
  return ages;
}

void ProbeCaptures::requireMap(int probe) const {
  if (!maps_ || probe < 0 || static_cast<std::size_t>(probe) >= shown_.size())
    throwInputError("the last frame has no cube map of probe {}", probe);
}

std::array<Image, 6> ProbeCaptures::read(int probe, int level) const {
  requireMap(probe);
  return maps_->read(probe, level);
}

std::array<Plane, 6> ProbeCaptures::readDistances(int probe) const {
  requireMap(probe);
  if (!needsDistances(technique_))
    throwInputError("lookup '{}' keeps no distances of probe {}", printSpec(technique_.lookup), probe);
  return maps_->readDistances(probe, nears_[static_cast<std::size_t>(probe)]);
}

}  // namespace pb
