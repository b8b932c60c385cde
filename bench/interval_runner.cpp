#include "bench/interval_runner.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "bench/hash.h"
#include "bench/interrupt.h"
#include "bench/jackknife.h"
#include "bench/truth.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

constexpr std::size_t kMetricCount = std::size(kIntervalMetrics);
constexpr std::size_t kMostBytes = std::size_t{512} << 20;  // of pictures in memory at a time

using Values = std::array<std::optional<double>, kMetricCount>;

Values valuesOf(const Metrics& metrics) {
  Values values;
  std::ranges::transform(kIntervalMetrics, values.begin(), [&](const char* key) { return metricValue(metrics, key); });
  return values;
}

// The replicates of one region of one cell.
class Replicates {
 public:
  void add(const Metrics& metrics) { all_.push_back(valuesOf(metrics)); }

  // Of the metrics that are defined against all references without a batch: so all cells have theirs in one order.
  MetricReplicates byMetric() const {
    MetricReplicates replicates;
    for (std::size_t m = 0; m < kMetricCount; ++m) {
      std::vector<double> values;
      for (const Values& replicate : all_)
        if (replicate[m]) values.push_back(*replicate[m]);
      if (values.size() == all_.size()) replicates.emplace_back(kIntervalMetrics[m], std::move(values));
    }
    return replicates;
  }

 private:
  std::vector<Values> all_;
};

MetricIntervals intervalsOf(const Metrics& metrics, const MetricReplicates& replicates) {
  MetricIntervals intervals;
  for (const auto& [metric, values] : replicates)
    if (const std::optional<double> value = metricValue(metrics, metric))
      intervals.emplace_back(metric, jackknifeInterval(*value, values));
  return intervals;
}

MetricIntervals exactIntervals(const Metrics& metrics) {
  const Values values = valuesOf(metrics);
  MetricIntervals intervals;
  for (std::size_t m = 0; m < kMetricCount; ++m)
    if (values[m]) intervals.emplace_back(kIntervalMetrics[m], Interval{*values[m], *values[m]});
  return intervals;
}

void setExact(CellResult& cell) {
  cell.intervals = exactIntervals(cell.metrics);
  if (cell.maskMetrics) cell.maskIntervals = exactIntervals(*cell.maskMetrics);
  cell.replicates = cell.maskReplicates = {};
  cell.referenceHash.clear();
}

// Equal for equal pictures in the same order.
std::string hashOf(const std::vector<Image>& batches) {
  std::string hashes;
  for (const Image& batch : batches)
    hashes += hexHash({reinterpret_cast<const char*>(batch.data()), batch.size() * sizeof(batch[0])});
  return hexHash(hashes);
}

void setNoise(CellResult& cell, MetricReplicates whole, MetricReplicates masked, const std::string& referenceHash) {
  cell.intervals = intervalsOf(cell.metrics, whole);
  cell.replicates = std::move(whole);
  cell.referenceHash = referenceHash;
  if (!cell.maskMetrics) return;
  cell.maskIntervals = intervalsOf(*cell.maskMetrics, masked);
  cell.maskReplicates = std::move(masked);
}

// By picture: the first one that is equal in every bit.
std::vector<std::size_t> firstEqual(const std::vector<Image>& pictures) {
  std::vector<std::size_t> first;
  for (const Image& picture : pictures)
    first.push_back(static_cast<std::size_t>(std::ranges::find(pictures, picture) - pictures.begin()));
  return first;
}

class IntervalRunner {
 public:
  IntervalRunner(const RunContext& context, bool rescores) : c_(context), rescores_(rescores) {}

  void run(std::vector<CellResult>& cells) {
    const auto groups = groupsOf(cells);
    std::size_t count = 0;
    for (const auto& [where, group] : groups) count += group.size();
    c_.progress.begin(rescores_ ? "scores" : "intervals", count);
    for (const auto& [where, group] : groups) addToFrame(where.first, where.second, group);
    c_.progress.end();
  }

 private:
  using Group = std::vector<CellResult*>;

  // By scene and frame: those with a picture.
  std::map<std::pair<std::size_t, int>, Group> groupsOf(std::vector<CellResult>& cells) const {
    std::map<std::string, CellResult*> byKey;
    for (CellResult& cell : cells)
      if (std::filesystem::exists(pictureOf(cell)) && !cell.pictures.rendered.empty()) byKey[cell.key()] = &cell;
    std::map<std::pair<std::size_t, int>, Group> groups;
    for (const PlannedSequence& sequence : c_.plan.sequences)
      for (const int frame : sequence.frames)
        if (const auto cell = byKey.find(makeCell(c_.suite, sequence, frame).key()); cell != byKey.end())
          groups[{sequence.scene, frame}].push_back(cell->second);
    return groups;
  }

  std::filesystem::path pictureOf(const CellResult& cell) const {
    return c_.directory.folder() / cell.pictures.rendered;
  }

  std::shared_ptr<const Snapshot> snapshot(std::size_t scene, int frame) const {
    return makeSnapshot(c_.scenes[scene], std::max(frame, 0), c_.suite.scenes[scene].camera, c_.suite.image.aspect());
  }

  void addToFrame(std::size_t scene, int frame, const Group& group) {
    throwIfInterrupted();
    std::vector<std::string> warnings;
    const TruthMaker maker = makerOf();
    const ReferenceImage reference = maker.reference(snapshot(scene, frame), warnings);
    const bool isExact = reference.batches.size() < 2 || areEqual(reference.batches);
    if (rescores_) say(warnings);  // else they were given when the cells were scored
    if (isExact && !rescores_) {
      for (CellResult* cell : group) addExact(*cell);
      return;
    }
    const double exposure = c_.suite.scenes[scene].exposure;
    const std::shared_ptr<const Truth> truth = maker.make(snapshot(scene, frame), exposure, warnings);
    const auto bytes = static_cast<std::size_t>(c_.suite.image.widthPx) *
                       static_cast<std::size_t>(c_.suite.image.heightPx) * sizeof(glm::vec3);
    const std::size_t most = std::max<std::size_t>(1, kMostBytes / bytes);
    for (std::size_t begin = 0; begin < group.size(); begin += most) {
      const Group part(group.begin() + static_cast<std::ptrdiff_t>(begin),
                       group.begin() + static_cast<std::ptrdiff_t>(std::min(group.size(), begin + most)));
      const std::vector<Image> pictures = picturesOf(part);
      const std::vector<std::size_t> first = firstEqual(pictures);  // which has the scores of them all
      if (rescores_) rescore(*truth, pictures, first, part);
      if (isExact)
        for (CellResult* cell : part) addExact(*cell);
      else
        addToCells(reference, *truth, exposure, pictures, first, part);
    }
  }

  void say(const std::vector<std::string>& warnings) const {
    for (const std::string& warning : warnings) c_.progress.message("warning: " + warning);
  }

  void addExact(CellResult& cell) const {
    setExact(cell);
    c_.progress.step();
  }

  std::vector<Image> picturesOf(const Group& group) const {
    std::vector<Image> pictures;
    for (const CellResult* cell : group) pictures.push_back(rgbOf(readImage(pictureOf(*cell).string()).pixels));
    return pictures;
  }

  TruthMaker makerOf() {
    if (!ids_) {
      Technique noProbes;
      noProbes.probes = ProbeUse::environmentOnly;
      ids_.emplace(c_.device, noProbes, c_.suite.image.widthPx, c_.suite.image.heightPx, c_.suite.image.samplesPerAxis);
    }
    return {c_.store, c_.suite.image, c_.suite.reference, [this](const Snapshot& s) { return ids_->renderIds(s); }};
  }

  // One reference without one of its batches at a time: prepared ones are large.
  void addToCells(const ReferenceImage& reference, const Truth& truth, double exposure,
                  const std::vector<Image>& pictures, const std::vector<std::size_t>& first, const Group& group) {
    const Mask& mask = truth.mask;
    std::vector<Replicates> whole(group.size()), masked(group.size());
    const Image mean = reference.mean();
    const MetricsSettings display{.exposure = exposure, .clampForDisplay = true};
    for (const Image& batch : reference.batches) {
      throwIfInterrupted();
      const MetricsReference rest(leaveOneOut(mean, batch, reference.batches.size()), display);
      tbb::parallel_for(std::size_t{0}, group.size(), [&](std::size_t i) {
        if (first[i] != i) return;
        const MetricsResult scores = rest.compare(pictures[i], mask.empty() ? nullptr : &mask);
        whole[i].add(scores.whole);
        if (scores.masked) masked[i].add(*scores.masked);
      });
    }
    const std::string referenceHash = hashOf(reference.batches);
    for (std::size_t i = 0; i < group.size(); ++i) {
      setNoise(*group[i], whole[first[i]].byMetric(), masked[first[i]].byMetric(), referenceHash);
      c_.progress.step();
    }
  }

  static void rescore(const Truth& truth, const std::vector<Image>& pictures, const std::vector<std::size_t>& first,
                      const Group& group) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      CellResult& cell = *group[i];
      if (first[i] == i) {
        const MetricsResult scores = truth.metrics.compare(pictures[i], truth.mask.empty() ? nullptr : &truth.mask);
        cell.metrics = scores.whole;
        cell.maskMetrics = scores.masked;
      } else {
        cell.metrics = group[first[i]]->metrics;
        cell.maskMetrics = group[first[i]]->maskMetrics;
      }
      cell.floor = truth.floor;
      cell.maskFloor = truth.maskFloor;
    }
  }

  const RunContext& c_;
  bool rescores_;
  std::optional<RasterSequence> ids_;
};

}  // namespace

void addIntervals(const RunContext& context, std::vector<CellResult>& cells) {
  IntervalRunner(context, false).run(cells);
}

void rescore(const RunContext& context, std::vector<CellResult>& cells) { IntervalRunner(context, true).run(cells); }

}  // namespace pb
