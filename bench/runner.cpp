#include "bench/runner.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "bench/attribution_runner.h"
#include "bench/axes.h"
#include "bench/bounce_depth.h"
#include "bench/cost.h"
#include "bench/cost_request.h"
#include "bench/external.h"
#include "bench/integrity.h"
#include "bench/interrupt.h"
#include "bench/interval_runner.h"
#include "bench/score.h"
#include "bench/truth.h"
#include "bench/version.h"
#include "raster/lookup.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

constexpr int kMaxWaitingCells = 8;  // images that wait for their metrics

// Work beside the calling thread, with a bound on what waits. run() and wait() throw what a task threw.
class TaskQueue {
 public:
  // What waits is finished even when the caller unwinds: cells that are rendered are kept.
  ~TaskQueue() {
    try {
      group_.wait();
    } catch (...) {  // the caller is on its way out with the first failure
    }
  }

  template <class Task>
  void run(Task task) {
    // With one thread nothing else takes tasks up: waiting here runs them.
    if (waiting_ >= kMaxWaitingCells) wait();
    ++waiting_;
    group_.run([this, task = std::move(task)] {
      task();
      --waiting_;
    });
  }

  void wait() {
    group_.wait();
    waiting_ = 0;
  }

 private:
  tbb::task_group group_;
  std::atomic<int> waiting_{0};
};

std::vector<std::pair<std::string, std::int64_t>> namedCounters(const FrameStats& stats) {
  const FrameCounters& counters = stats.counters;
  const std::vector<int>& ofProbes = stats.coats.ofProbes;
  const std::vector<int>& mirrors = stats.mirrors.ofProbes;
  return {{"faces_captured", counters.facesCaptured},
          {"draws", counters.draws},
          {"triangles", counters.triangles},
          {"fragments", counters.fragments},
          {"probe_bytes", counters.probeBytes},
          {"texels_filtered", counters.texelsFiltered},
          {"coats_from_probe", std::accumulate(ofProbes.begin(), ofProbes.end(), std::int64_t{0})},
          {"coats_from_environment", stats.coats.fromEnvironment},
          {"mirrors_from_probe", std::accumulate(mirrors.begin(), mirrors.end(), std::int64_t{0})},
          {"mirrors_from_environment", stats.mirrors.fromEnvironment}};
}

// Letters, digits and a few signs stay; anything else would be a surprise in a file name.
std::string fileName(std::string text) {
  for (char& c : text)
    if (std::string_view("/\\:?&*\"'<>| \t\n").find(c) != std::string_view::npos) c = '_';
  return text;
}

PictureName pictureName(const Suite& suite, const Scenes& scenes, std::size_t scene) {
  return {scenes[scene]->name, suite.scenes[scene].camera, scene, 0};
}

class Runner {
 public:
  explicit Runner(const RunContext& context) : c_(context) {
    for (const CellResult& cell : c_.directory.finishedCells()) finished_.emplace(cell.key(), cell);
  }

  RunOutcome run() {
    measureErrors();
    RunOutcome outcome;
    outcome.skipped = skipped_;
    outcome.cells = orderedCells();
    addIntervals(c_, outcome.cells);
    outcome.attribution = attribute(c_, outcome.cells);
    if (c_.suite.cost.repetitions > 0) outcome.benchmarkJson = measureCost(outcome.cells);
    outcome.noisyReferences = describeNoisyReferences(outcome.cells);
    return outcome;
  }

 private:
  using Truths = std::map<int, std::shared_ptr<const Truth>>;  // by frame
  using DepthsByFrame = std::map<int, std::set<int>>;

  const SuiteScene& suiteScene(std::size_t scene) const { return c_.suite.scenes[scene]; }

  // Frames before 0 show frame 0: warm-up of a scene that stands still until then.
  std::shared_ptr<const Snapshot> snapshot(std::size_t scene, int frame) const {
    return makeSnapshot(c_.scenes[scene], std::max(frame, 0), suiteScene(scene).camera, c_.suite.image.aspect());
  }

  bool isFinished(const PlannedSequence& sequence, int frame) {
    const std::lock_guard lock(mutex_);
    return finished_.contains(makeCell(c_.suite, sequence, frame).key());
  }

  std::vector<int> openFrames(const PlannedSequence& sequence) {
    std::vector<int> open;
    std::ranges::copy_if(sequence.frames, std::back_inserter(open),
                         [&](int frame) { return !isFinished(sequence, frame); });
    return open;
  }

  // The open frames and the measured frames before them, to which their flicker looks back.
  static std::vector<int> framesToRead(const PlannedSequence& sequence, const std::vector<int>& open) {
    std::vector<int> read;
    for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
      const bool precedesOpen =
          i + 1 < sequence.frames.size() && std::ranges::binary_search(open, sequence.frames[i + 1]);
      if (precedesOpen || std::ranges::binary_search(open, sequence.frames[i])) read.push_back(sequence.frames[i]);
    }
    return read;
  }

  void measureErrors() {
    for (std::size_t scene = 0; scene < c_.suite.scenes.size(); ++scene) measureScene(scene);
  }

  // The truths of one scene at a time are in memory.
  void measureScene(std::size_t scene) {
    std::vector<const PlannedSequence*> sequences;
    std::size_t cells = 0;
    for (const PlannedSequence& sequence : c_.plan.sequences) {
      if (sequence.scene != scene) continue;
      const std::size_t open = openFrames(sequence).size();
      if (open > 0) sequences.push_back(&sequence);
      cells += open;
    }
    if (sequences.empty()) return;
    if (c_.suite.reference.matched) followBounces(scene, sequences);
    const Truths truths = makeTruths(scene, depthsOf(sequences));
    c_.progress.begin(fmt::format("errors of {}", c_.scenes[scene]->name), cells);
    TaskQueue queue;
    for (const PlannedSequence* sequence : sequences) measureSequence(*sequence, truths, queue);
    queue.wait();
    c_.progress.end();
  }

  void followBounces(std::size_t scene, const std::vector<const PlannedSequence*>& sequences) {
    std::vector<const PlannedSequence*> followed;
    std::vector<Technique> techniques;
    int last = suiteScene(scene).startFrame();
    for (const PlannedSequence* sequence : sequences) {
      if (sequence->external) continue;
      followed.push_back(sequence);
      techniques.push_back(sequence->technique);
      last = std::max(last, sequence->frames.back());
    }
    std::vector<std::vector<int>> depths = bounceDepths(
        techniques, suiteScene(scene).startFrame(), last, [&](int frame) { return snapshot(scene, frame); },
        c_.suite.image.heightPx);
    for (std::size_t i = 0; i < followed.size(); ++i) depths_[followed[i]] = std::move(depths[i]);
  }

  // Of the truth that has as many bounces as the sequence at that frame.
  std::optional<int> depthOf(const PlannedSequence& sequence, int frame) const {
    const auto found = depths_.find(&sequence);
    if (found == depths_.end()) return std::nullopt;
    return found->second[static_cast<std::size_t>(frame - suiteScene(sequence.scene).startFrame())];
  }

  // The frames whose truths are wanted, and at which depths besides.
  DepthsByFrame depthsOf(const std::vector<const PlannedSequence*>& sequences) {
    DepthsByFrame depths;
    for (const PlannedSequence* sequence : sequences) {
      const std::vector<int> open = openFrames(*sequence);
      for (const int frame : framesToRead(*sequence, open)) depths[frame];
      for (const int frame : open)
        if (const std::optional<int> depth = depthOf(*sequence, frame)) depths[frame].insert(*depth);
    }
    return depths;
  }

  void measureExternal(const PlannedSequence& sequence, const Truths& truths, TaskQueue& queue) {
    throwIfInterrupted();
    queue.wait();  // it may measure its times
    const ExternalTechnique& technique = c_.suite.externals[*sequence.external];
    ExternalRequest request{technique,
                            pictureName(c_.suite, c_.scenes, sequence.scene),
                            c_.suite.image,
                            describe(c_.suite.technique),
                            {},
                            c_.suite.cost.repetitions};
    const std::vector<int> open = openFrames(sequence);
    const std::vector<int> read = framesToRead(sequence, open);
    for (int frame = suiteScene(sequence.scene).startFrame(); frame <= open.back(); ++frame)
      request.frames.push_back({frame, std::ranges::binary_search(read, frame), snapshot(sequence.scene, frame)});
    std::optional<RenderedFrame> before;
    const ExternalOutcome outcome =
        runExternal(request, [&](int frame, Image picture, const std::optional<ReportedCost>& cost) {
          const RenderedFrame shown{std::make_shared<const Image>(std::move(picture)), truths.at(frame), frame};
          const std::optional<RenderedFrame> shownBefore = std::exchange(before, shown);
          if (!std::ranges::binary_search(open, frame)) return;
          CellResult cell = makeCell(c_.suite, sequence, frame);
          cell.reportedCost = cost;
          queue.run([this, &sequence, cell = std::move(cell), shown, shownBefore] {
            finishCell(sequence, cell, {shown, shownBefore, std::nullopt, sequence.technique});
          });
        });
    const std::string what = fmt::format("external {} on {}", technique.name, suiteScene(sequence.scene).name);
    if (!outcome.messages.empty()) c_.progress.message(fmt::format("{}: {}", what, outcome.messages));
    if (!outcome.skipped) return;
    c_.progress.message(fmt::format("skipped: {}: {}", what, *outcome.skipped));
    skipped_.emplace_back(what, *outcome.skipped);
  }

  Truths makeTruths(std::size_t scene, const DepthsByFrame& depths) {
    Technique noProbes;
    noProbes.probes = ProbeUse::environmentOnly;
    RasterSequence idRaster(c_.device, noProbes, c_.suite.image.widthPx, c_.suite.image.heightPx,
                            c_.suite.image.samplesPerAxis);
    const TruthMaker maker(c_.store, c_.suite.image, c_.suite.reference,
                           [&](const Snapshot& s) { return idRaster.renderIds(s); });
    c_.progress.begin(fmt::format("references of {}", c_.scenes[scene]->name), depths.size());
    Truths truths;
    std::vector<std::string> warnings;
    for (const auto& [frame, wanted] : depths) {
      throwIfInterrupted();
      truths[frame] = maker.make(snapshot(scene, frame), suiteScene(scene).exposure, warnings, wanted);
      for (const std::string& warning : warnings) c_.progress.message("warning: " + warning);
      warnings.clear();
      writeExr((c_.directory.imagesFolder() / referenceName(scene, frame)).string(), truths[frame]->mean);
      c_.progress.step();
    }
    c_.progress.end();
    return truths;
  }

  void measureSequence(const PlannedSequence& sequence, const Truths& truths, TaskQueue& queue) {
    if (sequence.external) return measureExternal(sequence, truths, queue);
    const ImageSettings& image = c_.suite.image;
    RasterSequence raster(c_.device, sequence.technique, image.widthPx, image.heightPx, image.samplesPerAxis);
    const std::vector<int> open = openFrames(sequence);
    const std::vector<int> read = framesToRead(sequence, open);
    std::optional<RenderedFrame> before;
    for (int frame = suiteScene(sequence.scene).startFrame(); frame <= open.back(); ++frame) {
      throwIfInterrupted();
      const bool measured = std::ranges::binary_search(open, frame);
      const FrameStats stats = raster.renderFrame(*snapshot(sequence.scene, frame), measured);
      if (!std::ranges::binary_search(read, frame)) continue;
      const RenderedFrame shown{std::make_shared<const Image>(raster.readImage()), truths.at(frame), frame};
      const std::optional<RenderedFrame> shownBefore = std::exchange(before, shown);
      if (!measured) continue;
      MetricValues integrity;
      if (frame == sequence.frames.back())
        integrity = integrity_.measure(raster, sequence.technique, truths.at(frame)->snapshot, image.heightPx);
      queue.run([this, &sequence, frame, stats, integrity, shown, shownBefore] {
        CellResult cell = makeCell(c_.suite, sequence, frame);
        cell.integrity = integrity;
        cell.counters = namedCounters(stats);
        cell.faceAgeFrames = stats.faceAgeFrames;
        cell.coatsOfProbes = stats.coats.ofProbes;
        finishCell(sequence, std::move(cell), {shown, shownBefore, depthOf(sequence, frame), sequence.technique});
      });
    }
  }

  // Scores the image; `cell` has what does not come from it.
  void finishCell(const PlannedSequence& sequence, CellResult cell, const ScoreRequest& request) {
    const Plane flipHdrMap = scoreCell(request, cell);
    cell.pictures.reference = imagePath(referenceName(sequence.scene, cell.frame));
    if (c_.suite.pictures.everyFrame || cell.frame == sequence.frames.back())
      writeImages(sequence, cell, *request.frame.image, flipHdrMap);
    c_.directory.append(cell);
    const std::lock_guard lock(mutex_);
    finished_.emplace(cell.key(), std::move(cell));
    c_.progress.step();
  }

  // The last frame of a sequence shows its whole history; where the others are not kept, they come from `probebench
  // render --frame`.
  void writeImages(const PlannedSequence& sequence, CellResult& cell, const Image& image, const Plane& flipMap) const {
    std::string name = frameName(sequence.scene, cell.frame);
    if (sequence.external)
      name += fmt::format("-{}={}", kExternalAxis, c_.suite.externals[*sequence.external].name);
    else
      name += techniqueName(sequence);
    cell.pictures.rendered = imagePath(name + ".exr");
    cell.pictures.flip = imagePath(name + "-flip.png");
    writeExr((c_.directory.folder() / cell.pictures.rendered).string(), image);
    writePngEncoded((c_.directory.folder() / cell.pictures.flip).string(), magma(flipMap));
  }

  // The grid's axes, and what the scene varies.
  std::string techniqueName(const PlannedSequence& sequence) const {
    std::string name;
    const auto append = [&](const Axis& axis) {
      name += fmt::format("-{}={}", axis.name, fileName(axis.print(sequence.technique)));
    };
    for (const auto& [axis, values] : c_.suite.grid) append(axisNamed(axis));
    for (const std::string& varied : variedAxes(suiteScene(sequence.scene).vary))
      if (const Axis& axis = axisNamed(varied); axis.print(sequence.technique) != axis.print(c_.suite.technique))
        append(axis);
    return name;
  }

  // The scene's number keeps scenes of one name apart.
  std::string frameName(std::size_t scene, int frame) const {
    constexpr std::size_t kMaxLength = 60;  // file names have at most 255 bytes, the axes come behind
    return fmt::format("{}-{}-frame{}", scene, fileName(c_.scenes[scene]->name.substr(0, kMaxLength)), frame);
  }

  std::string referenceName(std::size_t scene, int frame) const { return frameName(scene, frame) + "-reference.exr"; }

  // As it stands in results: relative to the run's folder.
  std::string imagePath(const std::string& name) const {
    return (c_.directory.imagesFolder().filename() / name).generic_string();
  }

  std::vector<CellResult> orderedCells() const {
    std::vector<CellResult> cells;
    for (const PlannedSequence& sequence : c_.plan.sequences)
      for (const int frame : sequence.frames)
        if (const auto found = finished_.find(makeCell(c_.suite, sequence, frame).key()); found != finished_.end())
          cells.push_back(found->second);
        else
          assert(sequence.external && !skipped_.empty());
    return cells;
  }

  // From the cells, so that those of an earlier, interrupted run count too.
  std::vector<std::string> describeNoisyReferences(const std::vector<CellResult>& cells) const {
    const std::optional<double> limit = c_.suite.reference.maxNoise;
    std::vector<std::string> sentences;
    for (const NoisyReference& noisy : findNoisyReferences(cells, limit))
      sentences.push_back(
          fmt::format("max_noise is {:g}, but the reference of {} frame {} has {:.3g} at up to {} samples", *limit,
                      noisy.scene, noisy.frame, noisy.noise, mostSpp(c_.suite.reference)));
    return sentences;
  }

  // All costs belong to one run of the machine: they are measured together, also after --resume.
  std::string measureCost(std::vector<CellResult>& cells) {
    std::vector<CostRequest> requests;
    for (const PlannedSequence& sequence : c_.plan.sequences)
      if (!sequence.external) requests.push_back(makeCostRequest(c_.suite, c_.scenes, sequence));
    const std::map<std::string, std::string> context = {
        {"probebench_version", toolVersion()},
        {"probebench_git", gitHash()},
        {"suite", c_.suite.name},
        {"gl_backend", c_.device.info().backend},
        {"gl_renderer", c_.device.info().renderer},
        {"gl_version", c_.device.info().version},
        {"image_size", fmt::format("{}x{}", c_.suite.image.widthPx, c_.suite.image.heightPx)}};
    c_.progress.begin("cost", requests.size());
    CostRun run = measureCosts(c_.device, c_.suite.image, requests, c_.suite.cost.repetitions, context,
                               [&] { c_.progress.step(); });
    c_.progress.end();
    std::map<std::string, const CostResult*> costs;
    for (std::size_t i = 0; i < requests.size(); ++i) costs[requests[i].name] = &run.results[i];
    for (CellResult& cell : cells)
      if (const auto cost = costs.find(cell.sequenceKey()); cost != costs.end()) cell.cost = *cost->second;
    return run.benchmarkJson;
  }

  const RunContext& c_;
  IntegrityMeter integrity_;
  std::mutex mutex_;
  std::map<std::string, CellResult> finished_;                 // by key
  std::map<const PlannedSequence*, std::vector<int>> depths_;  // from the sequence's first frame on: BounceDepth
  std::vector<std::pair<std::string, std::string>> skipped_;
};

}  // namespace

Scenes loadScenes(Suite& suite) {
  Scenes scenes;
  for (SuiteScene& scene : suite.scenes) {
    scenes.push_back(loadScene(scene.reference));
    if (scene.camera.empty()) scene.camera = scenes.back()->cameras.front().name;
  }
  return scenes;
}

void requireExternals(const Suite& suite, const Scenes& scenes, const Plan& plan) {
  for (const PlannedSequence& sequence : plan.sequences)
    if (sequence.external)
      requireAvailable(suite.externals[*sequence.external], pictureName(suite, scenes, sequence.scene),
                       sequence.frames);
}

namespace {

// Whether a later frame may be refused of which the first one isn't: reflectors bend, probes part.
bool isRefusedLater(const Technique& technique) {
  return lookupOf(technique.lookup).isPlanar || technique.sharing.name == "distance";
}

void checkScene(const Suite& suite, const Scenes& scenes, const Plan& plan, std::size_t index, RasterDevice& device) {
  const SuiteScene& scene = suite.scenes[index];
  std::vector<const PlannedSequence*> left;
  for (const PlannedSequence& sequence : plan.sequences)
    if (sequence.scene == index && !sequence.external) left.push_back(&sequence);
  for (int frame = scene.startFrame(); !left.empty(); ++frame) {
    const auto snapshot = makeSnapshot(scenes[index], std::max(frame, 0), scene.camera, suite.image.aspect());
    for (const PlannedSequence* sequence : left)
      RasterSequence::check(device, sequence->technique, *snapshot, suite.image.widthPx, suite.image.heightPx,
                            suite.image.samplesPerAxis);
    std::erase_if(left, [&](const PlannedSequence* sequence) {
      return frame >= sequence->frames.back() || !isRefusedLater(sequence->technique);
    });
  }
}

// Pictures that were made earlier are of one scene and frame each.
void checkPicturesMadeEarlier(const Suite& suite, const Scenes& scenes, const Plan& plan) {
  std::set<std::pair<std::size_t, std::string>> files;  // by technique
  for (const PlannedSequence& sequence : plan.sequences) {
    if (!sequence.external || suite.externals[*sequence.external].images.empty()) continue;
    const ExternalTechnique& technique = suite.externals[*sequence.external];
    PictureName name = pictureName(suite, scenes, sequence.scene);
    for (const int frame : sequence.frames) {
      name.frame = frame;
      const std::string file = pictureFile(technique.images, name);
      if (!files.emplace(*sequence.external, file).second)
        throwInputError(
            "external technique '{}' has '{}' for more than one scene or frame, of which its 'images' want a picture "
            "each",
            technique.name, file);
    }
  }
}

}  // namespace

void checkPlan(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device) {
  checkPicturesMadeEarlier(suite, scenes, plan);
  for (std::size_t scene = 0; scene < suite.scenes.size(); ++scene) checkScene(suite, scenes, plan, scene, device);
  checkAttribution(suite, scenes, plan, device);
}

RunOutcome runPlan(const RunContext& context) { return Runner(context).run(); }

}  // namespace pb
