#include "bench/attribution_runner.h"

#include <algorithm>
#include <functional>
#include <map>

#include "bench/attribution_renders.h"
#include "bench/attribution_scores.h"
#include "bench/attribution_steps.h"
#include "bench/axes.h"
#include "bench/bounce_depth.h"
#include "bench/interrupt.h"
#include "bench/kept_pictures.h"
#include "bench/oracle.h"
#include "bench/truth.h"
#include "raster/fault.h"
#include "raster/shared_sequence.h"
#include "scenes/error.h"

namespace pb {
namespace {

struct Job {
  const PlannedSequence* sequence;
  const CellResult* cell;
};

Attribution attributionOf(const Job& job, const AttributedCell& cell) {
  return {job.cell->scene, job.cell->camera, job.cell->frame, job.cell->technique, cell.truncated.value_or(0), {}, {}};
}

// The jobs of one frame of a scene. Each attribution goes to `finish` as soon as all its images are scored.
class FrameAttributor {
 public:
  using Finish = std::function<void(Attribution)>;

  FrameAttributor(const RunContext& context, std::vector<Job> jobs, Finish finish)
      : c_(context),
        jobs_(std::move(jobs)),
        finish_(std::move(finish)),
        scene_(jobs_.front().sequence->scene),
        snapshot_(makeSnapshot(c_, scene_, jobs_.front().cell->frame)),
        cells_(attributedCells()),
        scores_(makeTruth()),
        chains_(jobs_.size()) {}

  void run() {
    scoreTruncated();
    scoreStale();
    const AttributionRenders renders =
        attributionRenders(cells_, snapshot_, settings().resolution, image().heightPx, !isFaultPlanted(c_.device));
    for (const TracedSet& set : renders.traced) scoreTraced(set);
    for (const FreshSet& set : renders.fresh) scoreFresh(set);
  }

 private:
  using Scored = AttributionScores::Scored;

  const AttributionSettings& settings() const { return *c_.suite.attribution; }
  const ImageSettings& image() const { return c_.suite.image; }

  std::vector<AttributedCell> attributedCells() const {
    std::vector<AttributedCell> cells;
    const std::vector<int> depths = depthsOfJobs();
    for (std::size_t i = 0; i < jobs_.size(); ++i)
      cells.push_back({jobs_[i].sequence->technique, depths[i], truncatedDepth(c_.suite.reference, depths[i])});
    return cells;
  }

  // The bounces of the techniques at that frame: the number of hits after which their truths show the environment.
  std::vector<int> depthsOfJobs() const {
    std::vector<int> depths;
    for (const Job& job : jobs_)
      if (job.cell->matched) depths.push_back(job.cell->matched->depth);
    if (depths.size() == jobs_.size()) return depths;
    std::vector<Technique> techniques;
    for (const Job& job : jobs_) techniques.push_back(job.sequence->technique);
    depths.clear();
    for (const std::vector<int>& ofFrames : bounceDepths(
             techniques, c_.suite.scenes[scene_].startFrame(), jobs_.front().cell->frame,
             [&](int frame) { return makeSnapshot(c_, scene_, frame); }, image().heightPx))
      depths.push_back(ofFrames.back());
    return depths;
  }

  std::shared_ptr<const Truth> makeTruth() const {
    Technique noProbes;
    noProbes.probes = ProbeUse::environmentOnly;
    RasterSequence idRaster(c_.device, noProbes, image().widthPx, image().heightPx, image().samplesPerAxis);
    const TruthMaker maker(c_.store, image(), c_.suite.reference,
                           [&](const Snapshot& s) { return idRaster.renderIds(s); });
    std::vector<std::string> warnings;
    auto truth = maker.make(snapshot_, c_.suite.scenes[scene_].exposure, warnings);
    say(warnings);
    return truth;
  }

  void say(const std::vector<std::string>& warnings) const {
    for (const std::string& warning : warnings) c_.progress.message("warning: " + warning);
  }

  void add(const ImageUse& use, const Scored& scored) {
    std::map<std::string, const Scored*>& chain = chains_[use.cell];
    chain[use.step] = &scored;
    if (chain.size() < chainLength(use.cell)) return;
    Attribution attribution = attributionOf(jobs_[use.cell], cells_[use.cell]);
    for (const AttributionStepInfo& step : attributionSteps())
      if (const auto found = chain.find(step.name); found != chain.end())
        addStep(step.name, *found->second, attribution);
    finish_(std::move(attribution));
  }

  // Images that are rasterised, and: local diffuse, truncated, stale.
  std::size_t chainLength(std::size_t cell) const {
    const std::size_t others = c_.suite.reference.diffuse == DiffuseTransport::traced ? 3 : 2;
    return rasterSteps(cells_[cell].technique, settings().resolution).size() + others;
  }

  void addAll(const std::vector<ImageUse>& uses, const Image& image) {
    const Scored& scored = scores_.score(image);
    for (const ImageUse& use : uses) add(use, scored);
  }

  void scoreTruncated() {
    std::map<std::optional<int>, std::vector<ImageUse>> uses;  // by depth
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
      if (c_.suite.reference.diffuse == DiffuseTransport::traced)
        uses[c_.suite.reference.depth].push_back({cell, "local diffuse"});
      uses[cells_[cell].truncated].push_back({cell, "truncated bounces"});
    }
    for (const auto& [depth, ofDepth] : uses) addAll(ofDepth, localTruth(depth));
  }

  // Of light as the raster has it: diffuse surfaces show that of their own point.
  Image localTruth(std::optional<int> depth) const {
    throwIfInterrupted();
    TruthSettings settings = c_.suite.reference;
    if (depth == settings.depth && settings.diffuse == DiffuseTransport::local) return scores_.truth().mean;
    settings.depth = depth;
    settings.diffuse = DiffuseTransport::local;
    settings.diffuseDepth = std::nullopt;
    std::vector<std::string> warnings;
    Image mean = TruthMaker(c_.store, image(), settings, {}).reference(snapshot_, warnings).mean();
    say(warnings);
    return mean;
  }

  // The cells' own images, which the run has rendered.
  void scoreStale() {
    const PictureNames names(c_.suite, c_.scenes);
    for (std::size_t cell = 0; cell < jobs_.size(); ++cell) {
      throwIfInterrupted();
      const Job& job = jobs_[cell];
      const std::string name = names.ofFrame(*job.sequence, job.cell->frame);
      addAll({{cell, "stale"}}, readPictureOf(c_.directory, *job.cell, name));
    }
  }

  void scoreTraced(const TracedSet& set) {
    throwIfInterrupted();
    ReferenceSettings tracing;
    tracing.spp = texelSpp(settings(), c_.suite.reference.spp);
    tracing.depth = set.depth;
    const OracleMaps maps = traceMaps(set.views, tracing, set.withDistances);
    for (const TracedImage& traced : set.images) {
      throwIfInterrupted();
      addAll(traced.uses, renderWithMaps(c_.device, traced.technique, *snapshot_, image(), maps));
    }
  }

  void scoreFresh(const FreshSet& set) {
    SharedSequence raster(c_.device, set.techniques, image().widthPx, image().heightPx, image().samplesPerAxis);
    for (int render = 1; render <= set.renders(); ++render) {
      throwIfInterrupted();
      raster.capture(snapshot_);
      for (const FreshImage& fresh : set.images) {
        if (fresh.renders != render) continue;
        raster.show(fresh.technique);
        addAll(fresh.uses, raster.readImage());
      }
    }
  }

  const RunContext& c_;
  const std::vector<Job> jobs_;
  const Finish finish_;
  const std::size_t scene_;
  const std::shared_ptr<const Snapshot> snapshot_;
  const std::vector<AttributedCell> cells_;
  AttributionScores scores_;
  std::vector<std::map<std::string, const Scored*>> chains_;  // by job: steps that are scored
};

class Attributor {
 public:
  explicit Attributor(const RunContext& context) : c_(context) {}

  std::vector<Attribution> run(const std::vector<CellResult>& cells) {
    for (const Attribution& done : c_.directory.finishedAttributions()) finished_.emplace(keyOfCell(done), done);
    const std::vector<Job> jobs = chooseJobs(cells);
    c_.progress.begin("attribution", jobs.size());
    for (const auto& [frame, open] : openByFrame(jobs)) {
      throwIfInterrupted();
      FrameAttributor(c_, open, [this](Attribution attribution) { finish(std::move(attribution)); }).run();
    }
    c_.progress.end();
    std::vector<Attribution> attributions;
    for (const Job& job : jobs) attributions.push_back(finished_.at(job.cell->key()));
    return attributions;
  }

 private:
  static std::string keyOfCell(const Attribution& attribution) {
    CellResult cell;
    cell.scene = attribution.scene;
    cell.camera = attribution.camera;
    cell.frame = attribution.frame;
    cell.technique = attribution.technique;
    return cell.key();
  }

  std::vector<Job> chooseJobs(const std::vector<CellResult>& cells) const {
    std::map<std::string, const CellResult*> byKey;
    for (const CellResult& cell : cells) byKey.emplace(cell.key(), &cell);
    std::vector<Job> jobs;
    for (const PlannedSequence& sequence : c_.plan.sequences)
      for (const int frame : sequence.attributedFrames) {
        const auto found = byKey.find(makeCell(c_.suite, sequence, frame).key());
        if (found == byKey.end()) continue;
        if (!sequence.external && takesOracleMaps(sequence.technique))
          jobs.push_back({&sequence, found->second});
        else
          c_.progress.message("no attribution, as it has no cube maps: " +
                              shortKey(found->first, describe(Technique())));
      }
    return jobs;
  }

  // Not yet finished ones by scene and frame, which have their truth in common. The others' progress is counted.
  std::map<std::pair<std::size_t, int>, std::vector<Job>> openByFrame(const std::vector<Job>& jobs) const {
    std::map<std::pair<std::size_t, int>, std::vector<Job>> open;
    for (const Job& job : jobs)
      if (finished_.contains(job.cell->key()))
        c_.progress.step();
      else
        open[{job.sequence->scene, job.cell->frame}].push_back(job);
    return open;
  }

  void finish(Attribution attribution) {
    c_.directory.append(attribution);
    std::string key = keyOfCell(attribution);
    finished_.emplace(std::move(key), std::move(attribution));
    c_.progress.step();
  }

  const RunContext& c_;
  std::map<std::string, Attribution> finished_;  // by the cell's key
};

}  // namespace

void checkAttribution(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device) {
  if (!suite.attribution) return;
  const ImageSettings& image = suite.image;
  for (const PlannedSequence& sequence : plan.sequences) {
    if (sequence.external || !takesOracleMaps(sequence.technique) || sequence.attributedFrames.empty()) continue;
    const auto snapshot = makeSnapshot(scenes[sequence.scene], sequence.frames.back(),
                                       suite.scenes[sequence.scene].camera, image.aspect());
    for (const RasterStep& step : rasterSteps(sequence.technique, suite.attribution->resolution)) {
      try {
        RasterSequence::check(device, step.technique, *snapshot, image.widthPx, image.heightPx, image.samplesPerAxis);
      } catch (const Error& error) {
        throw Error(error.kind(), fmt::format("attribution, step '{}': {}", step.step, error.what()));
      }
    }
  }
}

std::vector<Attribution> attribute(const RunContext& context, const std::vector<CellResult>& cells) {
  if (!context.suite.attribution) return {};
  return Attributor(context).run(cells);
}

}  // namespace pb
