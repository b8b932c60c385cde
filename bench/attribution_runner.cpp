#include "bench/attribution_runner.h"

#include <algorithm>
#include <map>

#include "bench/attribution_steps.h"
#include "bench/axes.h"
#include "bench/bounce_depth.h"
#include "bench/interrupt.h"
#include "bench/oracle.h"
#include "bench/traced_maps.h"
#include "bench/truth.h"
#include "raster/lookup.h"
#include "scenes/error.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

struct Job {
  const PlannedSequence* sequence;
  const CellResult* cell;
};

MetricValues definedValues(const Metrics& metrics) {
  MetricValues values;
  for (const MetricInfo& metric : metricTable())
    if (const std::optional<double> value = metric.value(metrics)) values.emplace_back(metric.key, *value);
  return values;
}

AttributionStep stepOf(const std::string& step, const RegionErrors& errors) {
  return {
      step, {{"mse", errors.mse}, {"relmse", errors.relmse}, {"bias", errors.bias}, {"flip_hdr", errors.flipHdr}}, {}};
}

class Attributor {
 public:
  explicit Attributor(const RunContext& context) : c_(context) {}

  std::vector<Attribution> run(const std::vector<CellResult>& cells) {
    for (const Attribution& done : c_.directory.finishedAttributions()) finished_.emplace(keyOfCell(done), done);
    const std::vector<Job> jobs = chooseJobs(cells);
    c_.progress.begin("attribution", jobs.size());
    for (const Job& job : byFrame(jobs)) {
      throwIfInterrupted();
      attributeCell(job);
      c_.progress.step();
    }
    c_.progress.end();
    std::vector<Attribution> attributions;
    for (const Job& job : jobs) attributions.push_back(finished_.at(job.cell->key()));
    return attributions;
  }

 private:
  // What the cells of one frame of a scene have in common.
  struct Frame {
    std::size_t scene;
    int frame;
    std::shared_ptr<const Snapshot> snapshot;
    std::shared_ptr<const Truth> truth;
    std::map<int, Image> truncated;  // by depth
  };

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

  // Cells that share their truth stand together.
  static std::vector<Job> byFrame(std::vector<Job> jobs) {
    std::ranges::stable_sort(jobs, {}, [](const Job& job) { return std::pair(job.sequence->scene, job.cell->frame); });
    return jobs;
  }

  std::shared_ptr<const Snapshot> snapshot(std::size_t scene, int frame) const {
    return makeSnapshot(c_.scenes[scene], std::max(frame, 0), c_.suite.scenes[scene].camera, c_.suite.image.aspect());
  }

  std::shared_ptr<const Truth> makeTruth(const Frame& frame, const TruthSettings& settings) const {
    Technique noProbes;
    noProbes.probes = ProbeUse::environmentOnly;
    const ImageSettings& image = c_.suite.image;
    RasterSequence idRaster(c_.device, noProbes, image.widthPx, image.heightPx, image.samplesPerAxis);
    const TruthMaker maker(c_.store, image, settings, [&](const Snapshot& s) { return idRaster.renderIds(s); });
    std::vector<std::string> warnings;
    auto truth = maker.make(frame.snapshot, c_.suite.scenes[frame.scene].exposure, warnings);
    for (const std::string& warning : warnings) c_.progress.message("warning: " + warning);
    return truth;
  }

  Frame& frameOf(const Job& job) {
    const std::size_t scene = job.sequence->scene;
    if (!frame_ || frame_->scene != scene || frame_->frame != job.cell->frame) {
      maps_.clear();
      frame_ = Frame{scene, job.cell->frame, snapshot(scene, job.cell->frame), nullptr, {}};
      frame_->truth = makeTruth(*frame_, c_.suite.reference);
    }
    return *frame_;
  }

  // Of light as the raster has it: diffuse surfaces show that of their own point.
  TruthSettings localTruth(std::optional<int> depth) const {
    TruthSettings settings = c_.suite.reference;
    settings.depth = depth;
    settings.diffuse = DiffuseTransport::local;
    settings.diffuseDepth = std::nullopt;
    return settings;
  }

  // The bounces of the technique at that frame: the number of hits after which its truth shows the environment.
  int depthOf(const Job& job) const {
    if (job.cell->matched) return job.cell->matched->depth;
    const std::size_t scene = job.sequence->scene;
    return bounceDepths(
               {job.sequence->technique}, c_.suite.scenes[scene].startFrame(), job.cell->frame,
               [&](int frame) { return snapshot(scene, frame); }, c_.suite.image.heightPx)
        .front()
        .back();
  }

  // The same as a setting of the reference; that of the truth itself where it has no more bounces.
  std::optional<int> truncation(int depth) const {
    const std::optional<int> ofTruth = c_.suite.reference.depth;
    if (depth >= kMaxMatchedDepth || (ofTruth && *ofTruth <= depth)) return ofTruth;
    return depth;
  }

  const Image& truncatedImage(Frame& frame, std::optional<int> depth) const {
    const bool isTruth = depth == c_.suite.reference.depth && c_.suite.reference.diffuse == DiffuseTransport::local;
    if (isTruth) return frame.truth->mean;
    const auto [found, isNew] = frame.truncated.try_emplace(depth.value_or(0));
    if (isNew) found->second = makeTruth(frame, localTruth(depth))->mean;
    return found->second;
  }

  void attributeCell(const Job& job) {
    if (finished_.contains(job.cell->key())) return;
    Frame& frame = frameOf(job);
    const int depth = depthOf(job);
    const std::optional<int> truncated = truncation(depth);
    Attribution attribution{
        job.cell->scene, job.cell->camera, job.cell->frame, job.cell->technique, truncated.value_or(0), {}, {}};
    Scores scores{frame, attribution};
    if (c_.suite.reference.diffuse == DiffuseTransport::traced)
      scores.add("local diffuse", truncatedImage(frame, c_.suite.reference.depth));
    scores.add("truncated bounces", truncatedImage(frame, truncated));
    for (const RasterStep& step : rasterSteps(job.sequence->technique, c_.suite.attribution->resolution)) {
      throwIfInterrupted();
      scores.add(step.step, step.isTraced ? renderTraced(step, frame, truncated) : renderFresh(step, frame, depth));
    }
    scores.add("stale", imageOf(job));
    c_.directory.append(attribution);
    finished_.emplace(job.cell->key(), std::move(attribution));
  }

  Image renderTraced(const RasterStep& step, const Frame& frame, std::optional<int> depth) {
    const ProbeViews views = probeViews(step.technique, frame.snapshot, c_.suite.image.heightPx);
    ReferenceSettings settings;
    settings.spp = texelSpp(*c_.suite.attribution, c_.suite.reference.spp);
    settings.depth = depth;
    const OracleMaps& maps = maps_.obtain(views, settings, needsDistances(step.technique));
    return renderWithMaps(c_.device, step.technique, *frame.snapshot, c_.suite.image, maps);
  }

  // In a world that stands still, as often as it takes for the maps to be as deep as the technique's.
  Image renderFresh(const RasterStep& step, const Frame& frame, int depth) const {
    const ImageSettings& image = c_.suite.image;
    RasterSequence sequence(c_.device, step.technique, image.widthPx, image.heightPx, image.samplesPerAxis);
    BounceDepth followed(step.technique, image.heightPx);
    const int enough = std::min(depth, kMaxMatchedDepth);
    for (int before = 0, now = 0;; before = now) {
      throwIfInterrupted();
      now = followed.advance(*frame.snapshot);
      sequence.renderFrame(*frame.snapshot);
      if (now >= enough || now == before) break;  // the same every time: no other probe, or none in memory
    }
    return sequence.readImage();
  }

  // The cell's own image: from the run's folder if it was kept there.
  Image imageOf(const Job& job) const {
    const std::filesystem::path kept = c_.directory.folder() / job.cell->pictures.rendered;
    if (!job.cell->pictures.rendered.empty() && std::filesystem::exists(kept))
      return rgbOf(readImage(kept.string()).pixels);
    const ImageSettings& image = c_.suite.image;
    RasterSequence sequence(c_.device, job.sequence->technique, image.widthPx, image.heightPx, image.samplesPerAxis);
    const std::size_t scene = job.sequence->scene;
    for (int f = c_.suite.scenes[scene].startFrame(); f <= job.cell->frame; ++f) {
      throwIfInterrupted();
      sequence.renderFrame(*snapshot(scene, f));
    }
    return sequence.readImage();
  }

  // Scores images into an attribution.
  struct Scores {
    const Frame& frame;
    Attribution& attribution;

    void add(const std::string& step, const Image& image) {
      const Truth& truth = *frame.truth;
      const MetricsResult result = truth.metrics.compare(image, truth.mask.empty() ? nullptr : &truth.mask);
      attribution.steps.push_back(
          {step, definedValues(result.whole), result.masked ? definedValues(*result.masked) : MetricValues()});
      const std::vector<ObjectError> objects =
          computeObjectErrors(*frame.snapshot, *frame.snapshot, truth.objects, truth.mean, image, result.flipHdrMap);
      if (attribution.objects.empty())
        for (const ObjectError& object : objects)
          attribution.objects.push_back({object.object, object.material, object.pixels, {}});
      for (std::size_t i = 0; i < objects.size(); ++i) attribution.objects[i].steps.push_back(stepOf(step, objects[i]));
    }
  };

  const RunContext& c_;
  std::map<std::string, Attribution> finished_;  // by the cell's key
  std::optional<Frame> frame_;
  TracedMaps maps_;
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
