#include "bench/work.h"

#include <algorithm>
#include <map>
#include <set>

#include "bench/attribution_renders.h"
#include "bench/attribution_steps.h"
#include "bench/bounce_depth.h"
#include "bench/capture_groups.h"
#include "bench/cost_model.h"
#include "bench/oracle.h"
#include "bench/raster_sequences.h"
#include "bench/truth.h"
#include "raster/captured_faces.h"
#include "raster/probe_layout.h"

namespace pb {
namespace {

constexpr double kMillion = 1e6;
constexpr double kRender = 0.05;  // millions of pixels that take as long as the draws of a render
constexpr double kScoring = 10;   // pixels of a picture that take as long as scoring one of it
// Frames that stand for a long sequence: refresh policies repeat much earlier.
constexpr int kMostModelFrames = 60;

double megapixels(const ImageSettings& image, int samplesPerAxis) {
  return static_cast<double>(image.widthPx) * image.heightPx * samplesPerAxis * samplesPerAxis / kMillion;
}

double texels(const ProbeViews& views) {
  double count = 0;
  for (const ProbeView& probe : views.probes) count += 6.0 * probe.resolutionPx * probe.resolutionPx;
  return count;
}

class WorkCounter {
 public:
  WorkCounter(const Suite& suite, const Scenes& scenes, const Plan& plan, const ReferenceStore& store)
      : suite_(suite), scenes_(scenes), plan_(plan), maker_(store, suite.image, suite.reference, {}) {}

  PlanWork count() {
    work_.suite = suite_.name;
    work_.mayRefine = suite_.reference.maxNoise.has_value();
    work_.units[{"control", suite_.name}] = 1;
    for (std::size_t scene = 0; scene < scenes_.size(); ++scene) countScene(scene);
    return work_;
  }

 private:
  std::shared_ptr<const Snapshot> snapshot(std::size_t scene, int frame) {
    std::shared_ptr<const Snapshot>& kept = snapshots_[frame];
    if (!kept)
      kept = makeSnapshot(scenes_[scene], std::max(frame, 0), suite_.scenes[scene].camera, suite_.image.aspect());
    return kept;
  }

  void countScene(std::size_t scene) {
    snapshots_.clear();
    depths_.clear();
    std::vector<const PlannedSequence*> sequences;
    for (const PlannedSequence& sequence : plan_.sequences)
      if (sequence.scene == scene) sequences.push_back(&sequence);
    if (sequences.empty()) return;
    countReferences(scene, sequences);
    const RasterSequences own = rasterSequencesOf(sequences, suite_.scenes[scene].startFrame());
    countSequences(own);
    if (suite_.attribution) countAttribution(own);
    pictures_ += static_cast<double>(sequences.size());
    work_.units[{"intervals", suite_.name}] = pictures_ * megapixels(suite_.image, 1) * kScoring;
  }

  void countReferences(std::size_t scene, const std::vector<const PlannedSequence*>& sequences) {
    std::set<std::pair<int, std::optional<int>>> pictures;  // frame and depth
    for (const PlannedSequence* sequence : sequences)
      for (const int frame : sequence->frames) pictures.emplace(frame, suite_.reference.depth);
    if (suite_.reference.matched) addMatchedDepths(scene, sequences, pictures);
    for (const auto& [frame, depth] : pictures) {
      ++work_.references;
      if (maker_.isStored(snapshot(scene, frame), depth))
        ++work_.stored;
      else
        work_.units[{"references", scenes_[scene]->name}] +=
            megapixels(suite_.image, suite_.image.samplesPerAxis) * suite_.reference.spp;
    }
  }

  void addMatchedDepths(std::size_t scene, const std::vector<const PlannedSequence*>& sequences,
                        std::set<std::pair<int, std::optional<int>>>& pictures) {
    followDepths(rasterSequencesOf(sequences, suite_.scenes[scene].startFrame()));
    for (const auto& [cell, depth] : depths_) pictures.emplace(cell.second, depth);
  }

  void followDepths(const RasterSequences& own) {
    if (own.sequences.empty()) return;
    const std::size_t scene = own.sequences.front()->scene;
    const auto depths = bounceDepths(
        own.techniques, own.first, own.last, [&](int frame) { return snapshot(scene, frame); }, suite_.image.heightPx);
    for (std::size_t i = 0; i < depths.size(); ++i)
      for (const int frame : own.sequences[i]->frames)
        depths_[{own.sequences[i], frame}] = depths[i][static_cast<std::size_t>(frame - own.first)];
  }

  void countSequences(const RasterSequences& own) {
    if (own.sequences.empty()) return;
    const std::size_t scene = own.sequences.front()->scene;
    for (const std::vector<std::size_t>& group : captureGroups(
             own.techniques, own.first, own.last, [&](int frame) { return snapshot(scene, frame); },
             suite_.image.heightPx)) {
      const std::size_t capturing =
          *std::ranges::max_element(group, {}, [&](std::size_t i) { return own.techniques[i].bounces; });
      for (const std::size_t i : group) countSequence(*own.sequences[i], group.size() > 1, i == capturing);
    }
  }

  // isShared: rendered together with others, from captures of one of them.
  void countSequence(const PlannedSequence& sequence, bool isShared, bool isCapturing) {
    const Technique& technique = sequence.technique;
    const int first = suite_.scenes[sequence.scene].startFrame();
    const int probes = static_cast<int>(ProbeLayout(technique).apply(*snapshot(sequence.scene, first)).probes.size());
    const int block = blockFrames(technique, probes, static_cast<int>(sequence.frames.size()));
    std::vector<std::shared_ptr<const Snapshot>> snapshots;
    for (int i = 0; i <= std::min(block, kMostModelFrames); ++i)
      snapshots.push_back(snapshot(sequence.scene, first + i));
    const double faces = modelRenders(technique, snapshots).perFrame - 1;
    const int frames = sequence.frames.back() - first + 1;
    const double face = static_cast<double>(technique.resolution) * technique.resolution / kMillion + kRender;
    // The first frame captures everything, whatever comes after it.
    const double captured = static_cast<double>(probes) * capturedFaceCount(technique) * technique.bounces +
                            static_cast<double>(frames - 1) * faces;
    // Those that share captures are shown in the frames that are measured.
    const std::size_t shown = isShared ? sequence.frames.size() : static_cast<std::size_t>(frames);
    work_.frames += shown;
    if (!isCapturing) work_.sharing += shown;
    if (isCapturing) work_.captures += captured;
    const double samples = megapixels(suite_.image, suite_.image.samplesPerAxis);
    work_.units[{"errors", scenes_[sequence.scene]->name}] +=
        static_cast<double>(shown) * (samples + kRender) + (isCapturing ? captured * face : 0.0) +
        static_cast<double>(sequence.frames.size()) * kScoring * megapixels(suite_.image, 1);
    countCost(block, faces * face);
  }

  // Truncated truths and traced maps; what is rasterised takes little beside them.
  void countAttribution(const RasterSequences& own) {
    std::map<int, std::vector<std::size_t>> attributed;  // by frame
    for (std::size_t i = 0; i < own.sequences.size(); ++i)
      if (takesOracleMaps(own.techniques[i]))
        for (const int frame : own.sequences[i]->attributedFrames) attributed[frame].push_back(i);
    if (attributed.empty()) return;
    const std::size_t scene = own.sequences.front()->scene;
    if (depths_.empty()) followDepths(own);
    double& units = work_.units[{"attribution", suite_.name}];
    for (const auto& [frame, sequences] : attributed) {
      std::vector<AttributedCell> cells;
      for (const std::size_t i : sequences) {
        const int depth = depths_.at({own.sequences[i], frame});
        cells.push_back({own.techniques[i], depth, truncatedDepth(suite_.reference, depth)});
      }
      units += truncatedTruths(cells) * megapixels(suite_.image, suite_.image.samplesPerAxis) * suite_.reference.spp;
      const AttributionRenders renders =
          attributionRenders(cells, snapshot(scene, frame), suite_.attribution->resolution, suite_.image.heightPx);
      work_.attribution.images += renders.imageCount();
      work_.attribution.traced += renders.traced.size();
      work_.attribution.captured += renders.fresh.size();
      for (const TracedSet& set : renders.traced)
        units += texels(set.views) / kMillion * texelSpp(*suite_.attribution, suite_.reference.spp);
    }
  }

  // Pictures of local light that neither are the truth nor one that cells are matched to, which the store has by then.
  double truncatedTruths(const std::vector<AttributedCell>& cells) const {
    const bool isLocal = suite_.reference.diffuse == DiffuseTransport::local;
    std::set<std::optional<int>> depths;
    if (!isLocal) depths.insert(suite_.reference.depth);
    if (!isLocal || !suite_.reference.matched)
      for (const AttributedCell& cell : cells) depths.insert(cell.truncated);
    if (isLocal) depths.erase(suite_.reference.depth);
    return static_cast<double>(depths.size());
  }

  // Blocks of frames, a warm-up and instrumented frames, and eight plain frames a repetition.
  void countCost(int block, double capturesAFrame) {
    const int repetitions = suite_.cost.repetitions;
    if (repetitions == 0) return;
    const double plain = megapixels(suite_.image, 1) + kRender;
    work_.blocks += static_cast<std::size_t>(repetitions);
    work_.units[{"cost", suite_.name}] +=
        (repetitions + 2) * block * (plain + capturesAFrame) + repetitions * 8 * plain;
  }

  const Suite& suite_;
  const Scenes& scenes_;
  const Plan& plan_;
  TruthMaker maker_;
  PlanWork work_;
  double pictures_ = 0;  // that get intervals
  // Of one scene.
  std::map<int, std::shared_ptr<const Snapshot>> snapshots_;
  std::map<std::pair<const PlannedSequence*, int>, int> depths_;  // by measured frame: bounces
};

}  // namespace

PlanWork computeWork(const Suite& suite, const Scenes& scenes, const Plan& plan, const ReferenceStore& store) {
  return WorkCounter(suite, scenes, plan, store).count();
}

WorkKind kindOfPhase(const std::string& phase, const std::string& suite) {
  const std::size_t of = phase.find(" of ");
  return of == std::string::npos ? WorkKind(phase, suite) : WorkKind(phase.substr(0, of), phase.substr(of + 4));
}

}  // namespace pb
