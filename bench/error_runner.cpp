#include "bench/error_runner.h"

#include <algorithm>
#include <map>
#include <set>

#include "bench/axes.h"
#include "bench/bounce_depth.h"
#include "bench/capture_groups.h"
#include "bench/cell_finisher.h"
#include "bench/external.h"
#include "bench/integrity.h"
#include "bench/interrupt.h"
#include "bench/picture_names.h"
#include "bench/raster_sequences.h"
#include "bench/score.h"
#include "bench/task_queue.h"
#include "bench/truth.h"
#include "raster/fault.h"
#include "raster/shared_sequence.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

constexpr int kMaxWaitingTasks = 8;  // of scoring, with their pictures

// A sequence of which frames are open, and where it is.
struct OpenSequence {
  const PlannedSequence& planned;
  std::vector<int> open, read;  // measured frames: not finished yet; those whose pictures are read
  std::optional<RenderedFrame> before{};
};

// Pictures of one frame that are equal, and whose they are.
struct EqualPictures {
  RenderedFrame shown;
  std::optional<int> depth;
  struct Use {
    const PlannedSequence& sequence;
    CellResult cell;
    std::optional<RenderedFrame> before;
  };
  std::vector<Use> uses;
};

class ErrorRunner {
 public:
  ErrorRunner(const RunContext& context, FinishedCells& finished)
      : c_(context), names_(context.suite, context.scenes), finisher_(context, finished) {}

  SkippedExternals run() {
    for (std::size_t scene = 0; scene < c_.suite.scenes.size(); ++scene) measureScene(scene);
    return std::move(skipped_);
  }

 private:
  using Truths = std::map<int, std::shared_ptr<const Truth>>;  // by frame
  using DepthsByFrame = std::map<int, std::set<int>>;
  using Sequences = std::vector<const PlannedSequence*>;

  const SuiteScene& suiteScene(std::size_t scene) const { return c_.suite.scenes[scene]; }

  // Frames before 0 show frame 0: warm-up of a scene that stands still until then.
  std::shared_ptr<const Snapshot> snapshot(std::size_t scene, int frame) const {
    return makeSnapshot(c_.scenes[scene], std::max(frame, 0), suiteScene(scene).camera, c_.suite.image.aspect());
  }

  std::vector<int> openFrames(const PlannedSequence& sequence) {
    std::vector<int> open;
    std::ranges::copy_if(sequence.frames, std::back_inserter(open),
                         [&](int frame) { return !finisher_.isFinished(sequence, frame); });
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

  // The truths of one scene at a time are in memory.
  void measureScene(std::size_t scene) {
    Sequences sequences;
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
    TaskQueue queue(kMaxWaitingTasks);
    for (const Sequences& group : groupsOf(scene, sequences)) measureGroup(group, truths, queue);
    for (const PlannedSequence* sequence : sequences)
      if (sequence->external) measureExternal(*sequence, truths, queue);
    queue.wait();
    c_.progress.end();
  }

  // Sequences that are rendered together; without external ones. With a planted fault each is alone: faults may act
  // otherwise on captures that are shared.
  std::vector<Sequences> groupsOf(std::size_t scene, const Sequences& sequences) const {
    const RasterSequences own = rasterSequencesOf(sequences, suiteScene(scene).startFrame());
    std::vector<Sequences> groups;
    if (isFaultPlanted(c_.device)) {
      for (const PlannedSequence* sequence : own.sequences) groups.push_back({sequence});
      return groups;
    }
    for (const std::vector<std::size_t>& members : captureGroups(
             own.techniques, own.first, own.last, [&](int frame) { return snapshot(scene, frame); },
             c_.suite.image.heightPx)) {
      Sequences& group = groups.emplace_back();
      for (const std::size_t member : members) group.push_back(own.sequences[member]);
    }
    return groups;
  }

  void followBounces(std::size_t scene, const std::vector<const PlannedSequence*>& sequences) {
    const RasterSequences own = rasterSequencesOf(sequences, suiteScene(scene).startFrame());
    std::vector<std::vector<int>> depths = bounceDepths(
        own.techniques, own.first, own.last, [&](int frame) { return snapshot(scene, frame); },
        c_.suite.image.heightPx);
    for (std::size_t i = 0; i < depths.size(); ++i) depths_[own.sequences[i]] = std::move(depths[i]);
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
    ExternalRequest request{technique, names_.external(sequence.scene), c_.suite.image, describe(c_.suite.technique),
                            {},        c_.suite.cost.repetitions};
    const std::vector<int> open = openFrames(sequence);
    const std::vector<int> read = framesToRead(sequence, open);
    for (int frame = suiteScene(sequence.scene).startFrame(); frame <= open.back(); ++frame)
      request.frames.push_back({frame, std::ranges::binary_search(read, frame), snapshot(sequence.scene, frame)});
    std::optional<RenderedFrame> before;
    const ExternalOutcome outcome = runExternal(request, [&](int frame, Image picture,
                                                             const std::optional<ReportedCost>& cost) {
      const RenderedFrame shown{std::make_shared<const Image>(std::move(picture)), truths.at(frame), frame};
      const std::optional<RenderedFrame> shownBefore = std::exchange(before, shown);
      if (!std::ranges::binary_search(open, frame)) return;
      CellResult cell = makeCell(c_.suite, sequence, frame);
      cell.reportedCost = cost;
      queue.run([this, &sequence, cell = std::move(cell), shown, shownBefore] {
        finisher_.finish(sequence, cell, scorePicture(*shown.truth, *shown.image, std::nullopt), shown, shownBefore);
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
      writeExr((c_.directory.imagesFolder() / names_.ofReference(scene, frame)).string(), truths[frame]->mean);
      c_.progress.step();
    }
    c_.progress.end();
    return truths;
  }

  void measureGroup(const Sequences& group, const Truths& truths, TaskQueue& queue) {
    const ImageSettings& image = c_.suite.image;
    std::vector<OpenSequence> sequences;
    std::vector<Technique> techniques;
    int last = 0;
    for (const PlannedSequence* planned : group) {
      std::vector<int> open = openFrames(*planned);
      std::vector<int> read = framesToRead(*planned, open);
      last = std::max(last, open.back());
      sequences.push_back({*planned, std::move(open), std::move(read)});
      techniques.push_back(planned->technique);
    }
    SharedSequence raster(c_.device, techniques, image.widthPx, image.heightPx, image.samplesPerAxis);
    const std::size_t scene = group.front()->scene;
    for (int frame = suiteScene(scene).startFrame(); frame <= last; ++frame) {
      throwIfInterrupted();
      const bool isMeasured = std::ranges::any_of(
          sequences, [&](const OpenSequence& s) { return std::ranges::binary_search(s.open, frame); });
      raster.capture(snapshot(scene, frame), isMeasured);
      for (EqualPictures& pictures : showFrame(frame, sequences, raster, truths))
        queue.run([this, pictures = std::move(pictures)] { finishCells(pictures); });
    }
  }

  // The pictures of the frame that are measured, equal ones together.
  std::vector<EqualPictures> showFrame(int frame, std::vector<OpenSequence>& sequences, SharedSequence& raster,
                                       const Truths& truths) {
    std::vector<EqualPictures> distinct;
    std::optional<MetricValues> integrity;
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      OpenSequence& sequence = sequences[i];
      if (!std::ranges::binary_search(sequence.read, frame)) continue;
      const PlannedSequence& planned = sequence.planned;
      const FrameStats stats = raster.show(i);
      RenderedFrame shown{std::make_shared<const Image>(raster.readImage()), truths.at(frame), frame};
      const std::optional<int> depth = depthOf(planned, frame);
      const bool isMeasured = std::ranges::binary_search(sequence.open, frame);
      auto same = std::ranges::find_if(distinct, [&](const EqualPictures& other) {
        return other.depth == depth && *other.shown.image == *shown.image;
      });
      if (same != distinct.end()) shown = same->shown;
      const std::optional<RenderedFrame> before = std::exchange(sequence.before, shown);
      if (!isMeasured) continue;
      if (same == distinct.end()) same = distinct.insert(same, {std::move(shown), depth, {}});
      CellResult cell = makeCell(c_.suite, planned, frame);
      fillIn(stats, cell);
      if (frame == planned.frames.back()) {
        if (!integrity)  // of maps that they share
          integrity =
              integrity_.measure(raster.maps(), planned.technique, truths.at(frame)->snapshot, c_.suite.image.heightPx);
        cell.integrity = *integrity;
      }
      same->uses.push_back({planned, std::move(cell), before});
    }
    return distinct;
  }

  void finishCells(const EqualPictures& pictures) {
    const RenderedFrame& shown = pictures.shown;
    const PictureScores scores = scorePicture(*shown.truth, *shown.image, pictures.depth);
    for (const EqualPictures::Use& use : pictures.uses)
      finisher_.finish(use.sequence, use.cell, scores, shown, use.before);
  }

  const RunContext& c_;
  const PictureNames names_;
  IntegrityMeter integrity_;
  CellFinisher finisher_;
  std::map<const PlannedSequence*, std::vector<int>> depths_;  // from the sequence's first frame on: BounceDepth
  SkippedExternals skipped_;
};

}  // namespace

SkippedExternals measureErrors(const RunContext& context, FinishedCells& finished) {
  return ErrorRunner(context, finished).run();
}

}  // namespace pb
