#include "bench/error_runner.h"

#include <algorithm>
#include <map>
#include <set>

#include "bench/bounce_depth.h"
#include "bench/cell_finisher.h"
#include "bench/external_sequence.h"
#include "bench/interrupt.h"
#include "bench/kept_pictures.h"
#include "bench/picture_names.h"
#include "bench/raster_sequences.h"
#include "bench/score.h"
#include "bench/task_queue.h"
#include "bench/truth.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

constexpr int kMaxWaitingTasks = 8;  // of scoring, with their pictures

// A sequence of which frames are open, and where it is.
struct OpenSequence {
  const PlannedSequence& planned;
  std::vector<int> open, read;  // measured frames: not finished yet; those whose pictures are needed
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
  ErrorRunner(const RunContext& context, FinishedCells& finished, const SkippedExternals& skipped)
      : c_(context),
        names_(context.suite, context.scenes),
        kept_(context),
        finisher_(context, finished),
        skipped_(skipped) {}

  SkippedExternals run() {
    for (std::size_t scene = 0; scene < c_.suite.scenes.size(); ++scene) measureScene(scene);
    return std::move(skipped_);
  }

 private:
  using Truths = std::map<int, std::shared_ptr<const Truth>>;  // by frame
  using DepthsByFrame = std::map<int, std::set<int>>;

  const SuiteScene& suiteScene(std::size_t scene) const { return c_.suite.scenes[scene]; }

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
    Sequences kept, missing;
    for (const PlannedSequence* sequence : sequences) (isKept(*sequence) ? kept : missing).push_back(sequence);
    measureKept(kept, truths, queue);
    measureMissing(missing, truths, queue);
    queue.wait();
    c_.progress.end();
  }

  // Whether nothing of it needs to be rendered.
  bool isKept(const PlannedSequence& sequence) {
    return kept_.haveAll(sequence, framesToRead(sequence, openFrames(sequence)));
  }

  // Those that were rendered together are scored together: they may have equal pictures.
  void measureKept(const Sequences& sequences, const Truths& truths, TaskQueue& queue) {
    std::vector<Sequences> groups = renderedTogether(c_, sequences);
    for (const PlannedSequence* sequence : sequences)
      if (sequence->external) groups.push_back({sequence});
    for (const Sequences& group : groups) {
      KeptSource source(kept_, group);
      measureGroup(group, source, truths, queue);
    }
  }

  void measureMissing(const Sequences& sequences, const Truths& truths, TaskQueue& queue) {
    for (const Sequences& group : renderedTogether(c_, sequences)) {
      const std::size_t scene = group.front()->scene;
      RasterSource source(
          c_, group,
          [&](int frame) {
            const auto measured = truths.find(frame);
            return measured == truths.end() ? makeSnapshot(c_, scene, frame) : measured->second->snapshot;
          },
          integrity_);
      measureGroup(group, source, truths, queue);
    }
    for (const PlannedSequence* sequence : sequences)
      if (sequence->external) measureExternal(*sequence, truths, queue);
  }

  void followBounces(std::size_t scene, const std::vector<const PlannedSequence*>& sequences) {
    const RasterSequences own = rasterSequencesOf(sequences, suiteScene(scene).startFrame());
    std::vector<std::vector<int>> depths = bounceDepths(
        own.techniques, own.first, own.last, [&](int frame) { return makeSnapshot(c_, scene, frame); },
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
    if (std::ranges::find(skipped_, nameOfExternal(c_, sequence), &Skipped::first) != skipped_.end()) return;
    queue.wait();  // it may measure its times
    const std::vector<int> open = openFrames(sequence);
    std::optional<RenderedFrame> before;
    std::optional<Skipped> skipped = renderExternal(c_, sequence, framesToRead(sequence, open), [&](ShownFrame taken) {
      const int frame = taken.cell.frame;
      const RenderedFrame shown{std::make_shared<const Image>(std::move(taken.image)), truths.at(frame), frame};
      const std::optional<RenderedFrame> shownBefore = std::exchange(before, shown);
      if (!std::ranges::binary_search(open, frame)) return;
      queue.run([this, &sequence, cell = std::move(taken.cell), shown, shownBefore] {
        finisher_.finish(sequence, cell, scorePicture(*shown.truth, *shown.image, std::nullopt), shown, shownBefore);
      });
    });
    if (skipped) skipped_.push_back(*std::move(skipped));
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
      truths[frame] = maker.make(makeSnapshot(c_, scene, frame), suiteScene(scene).exposure, warnings, wanted);
      for (const std::string& warning : warnings) c_.progress.message("warning: " + warning);
      warnings.clear();
      writeExr((c_.directory.imagesFolder() / names_.ofReference(scene, frame)).string(), truths[frame]->mean);
      c_.progress.step();
    }
    c_.progress.end();
    return truths;
  }

  void measureGroup(const Sequences& group, PictureSource& source, const Truths& truths, TaskQueue& queue) {
    std::vector<OpenSequence> sequences;
    int last = 0;
    for (const PlannedSequence* planned : group) {
      std::vector<int> open = openFrames(*planned);
      std::vector<int> read = framesToRead(*planned, open);
      last = std::max(last, open.back());
      sequences.push_back({*planned, std::move(open), std::move(read)});
    }
    for (int frame = suiteScene(group.front()->scene).startFrame(); frame <= last; ++frame) {
      throwIfInterrupted();
      const bool isMeasured = std::ranges::any_of(
          sequences, [&](const OpenSequence& s) { return std::ranges::binary_search(s.open, frame); });
      source.advance(frame, isMeasured);
      for (EqualPictures& pictures : showFrame(frame, sequences, source, truths))
        queue.run([this, pictures = std::move(pictures)] { finishCells(pictures); });
    }
  }

  // The pictures of the frame that are measured, equal ones together.
  std::vector<EqualPictures> showFrame(int frame, std::vector<OpenSequence>& sequences, PictureSource& source,
                                       const Truths& truths) {
    std::vector<EqualPictures> distinct;
    for (std::size_t i = 0; i < sequences.size(); ++i) {
      OpenSequence& sequence = sequences[i];
      if (!std::ranges::binary_search(sequence.read, frame)) continue;
      const PlannedSequence& planned = sequence.planned;
      ShownFrame taken = source.show(i);
      RenderedFrame shown{std::make_shared<const Image>(std::move(taken.image)), truths.at(frame), frame};
      const std::optional<int> depth = depthOf(planned, frame);
      auto same = std::ranges::find_if(distinct, [&](const EqualPictures& other) {
        return other.depth == depth && *other.shown.image == *shown.image;
      });
      if (same != distinct.end()) shown = same->shown;
      const std::optional<RenderedFrame> before = std::exchange(sequence.before, shown);
      if (!std::ranges::binary_search(sequence.open, frame)) continue;
      if (same == distinct.end()) same = distinct.insert(same, {std::move(shown), depth, {}});
      same->uses.push_back({planned, std::move(taken.cell), before});
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
  const KeptPictures kept_;
  IntegrityMeter integrity_;
  CellFinisher finisher_;
  std::map<const PlannedSequence*, std::vector<int>> depths_;  // from the sequence's first frame on: BounceDepth
  SkippedExternals skipped_;
};

}  // namespace

SkippedExternals measureErrors(const RunContext& context, FinishedCells& finished, const SkippedExternals& skipped) {
  return ErrorRunner(context, finished, skipped).run();
}

}  // namespace pb
