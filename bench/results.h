// What a run found, as data: the model behind results.json (schema: results/schema/results.schema.json) and
// results.csv.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/attribution.h"
#include "bench/cell_pictures.h"
#include "bench/clusters.h"
#include "bench/material_errors.h"
#include "bench/metrics/metrics.h"
#include "bench/object_errors.h"
#include "bench/tolerance.h"

namespace pb {

// The value of a metric by its key in metricTable(); nullopt where it is undefined. Throws an input Error for any other
// key.
std::optional<double> metricValue(const Metrics& metrics, const std::string& key);
// True of what is no metric.
bool isLowerBetter(const std::string& key);

inline constexpr int kResultsSchemaVersion = 1;

// Provenance::controlOutcome of a run whose control passed; anything else says why not.
inline constexpr char kControlPassed[] = "passed";

// Circumstances of a run. Everything that a reader needs to judge or repeat a number.
struct Provenance {
  std::string toolVersion, gitHash, suiteName, suiteHash;
  std::string startedAt;  // UTC, ISO 8601
  std::string cpu;
  int threads = 0;
  std::string glBackend, glRenderer, glVersion;
  std::map<std::string, std::string> libraries;    // name -> version
  std::map<std::string, std::string> sceneHashes;  // scene reference -> content hash of its rendered frames
  // Image size, samples, reference depth and noise, ... as the reader should see them: name -> value, in print order.
  std::vector<std::pair<std::string, std::string>> settings;
  std::uint64_t seed = 0;
  std::optional<double> maxNoise;  // largest relMSE of a reference's own noise that the suite accepts
  std::string controlOutcome;      // kControlPassed or why not; of `certify`'s control, run before the suite
};

// Axes of techniques and their values, in axis order.
using AxisValues = std::vector<std::pair<std::string, std::string>>;

// Some metrics by their keys (see metricTable()).
using MetricValues = std::vector<std::pair<std::string, double>>;

// Two-sided, of a metric.
struct Interval {
  double low = 0, high = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};
using MetricIntervals = std::vector<std::pair<std::string, Interval>>;

// Of some metrics, against the mean of a reference's batches without each of them, in their order: bench/jackknife.h.
using MetricReplicates = std::vector<std::pair<std::string, std::vector<double>>>;

// A cell against the truth that has as many bounces as the technique: what is left is not for want of bounces.
struct MatchedErrors {
  int depth = 0;           // specular hits after which that truth shows the environment: see bench/bounce_depth.h
  bool converged = false;  // nothing is missing at this depth: it is the converged truth
  Metrics metrics;         // whole image
  std::optional<Metrics> maskMetrics;
  MetricValues floor, maskFloor;
};

// Mean over pixels and channels of |(I_f - I_e) - (R_f - R_e)| / (f - e) for frame f and the measured frame e before
// it: change that only one of the two renderers shows, radiance a frame.
struct Flicker {
  double whole = 0;
  std::optional<double> mask{};  // over the pixels of reflective and refractive objects in either frame

  friend bool operator==(const Flicker&, const Flicker&) = default;
};

// Of the single frames of all repetitions, milliseconds.
struct CostPeaks {
  double p50 = 0, p95 = 0, p99 = 0, worst = 0;
  friend bool operator==(const CostPeaks&, const CostPeaks&) = default;
};

struct CostResult {
  int repetitions = 0;
  double frameMs = 0, frameMsLow = 0, frameMsHigh = 0;  // median over repetitions and its 95 % interval
  double plainMs = 0;                                   // plain frame, same scene and size, interleaved
  double ratio = 0, ratioLow = 0, ratioHigh = 0;        // frame / plain, median of the repetitions' own ratios
  // Of the repetitions, in their order, of processor time on software GL; older results have none.
  std::vector<double> ratios;
  std::vector<double> captureMs;       // by bounce iteration, instrumented run
  double shadowMs = 0;                 // shadow maps, instrumented run
  double prefilterMs = 0;              // all bounce iterations, instrumented run
  double finalMs = 0;                  // instrumented run
  double rendersPerFrame = 0;          // cost model: 1 + B * scheduled faces, mean over the frames
  double measuredRendersPerFrame = 0;  // 1 + faces captured, mean over the same frames
  std::string rendersFormula;          // "6*N*B+1 = 31" or "1+B*faces = 4"
  std::optional<CostPeaks> peaks;      // absent in results from before they were recorded
};

// Frame times as an external program states them: its own clock, its own idea of a frame.
struct ReportedCost {
  std::string program;                                  // as it calls itself
  int frames = 0;                                       // measured
  double frameMs = 0, frameMsLow = 0, frameMsHigh = 0;  // median over the frames and its 95 % interval
  std::optional<double> plainMs;                        // median of its own plain frames, if it measured any

  std::optional<double> ratio() const { return plainMs ? std::optional(frameMs / *plainMs) : std::nullopt; }
  friend bool operator==(const ReportedCost&, const ReportedCost&) = default;
};

// The one axis of cells of external techniques; its value is the technique's name.
inline constexpr char kExternalAxis[] = "external";

// Frames since the faces of a probe were captured, GL order; -1 for those that are never captured.
using FaceAges = std::array<std::int64_t, 6>;
// Over the faces that are captured; nullopt if none is.
struct AgeSummary {
  double mean;
  std::int64_t largest;
};
std::optional<AgeSummary> summaryOf(const std::vector<FaceAges>& ages);

struct CellResult {
  std::string scene, camera;
  int frame = 0;
  AxisValues technique;                // every axis that the program knew
  Metrics metrics;                     // against the converged truth, whole image
  std::optional<Metrics> maskMetrics;  // over the pixels of reflective and refractive objects, if there are any
  // What the reference's own noise adds to "mse" and "relmse" (and to other metrics whose floor is known).
  MetricValues floor, maskFloor;
  MetricValues unbiased;                        // "mse": mean((I-A)(I-B)), whole image
  MetricIntervals intervals, maskIntervals;     // 95 %, of some metrics, from the reference's noise
  MetricReplicates replicates, maskReplicates;  // what these come from; none where the reference has no noise
  // Of the batches behind the replicates: cells that have it in common have their noise in common.
  std::string referenceHash;
  std::optional<MatchedErrors> matched;      // absent where the technique's number of bounces is not known
  std::optional<CostResult> cost;            // of the technique on this scene; the same for all its frames
  std::optional<ReportedCost> reportedCost;  // of external techniques only, which have no `cost`
  // FrameCounters of this frame: "faces_captured", "draws", "triangles", "fragments", "probe_bytes", "texels_filtered";
  // what serves the coats of instances without a probe of their own: "coats_from_probe", "coats_from_environment".
  std::vector<std::pair<std::string, std::int64_t>> counters;
  std::vector<FaceAges> faceAgeFrames;  // of each probe
  std::vector<int> coatsOfProbes;       // by probe: instances whose coat it serves, without one of their own
  std::vector<MaterialError> materials;
  CellPictures pictures;
  std::vector<ObjectError> objects;
  std::vector<ErrorCluster> clusters;  // the largest first
  std::optional<Flicker> flicker;      // absent at a sequence's first measured frame
  MetricValues integrity;              // of the probes' maps, at a sequence's last measured frame: bench/integrity.h

  // "scene=... camera=... frame=.. resolution=64 ...": identifies the cell in a run and in --only.
  std::string key() const;
  // The same without the frame: cells of one sequence share their cost.
  std::string sequenceKey() const;
};

// A key of a cell or sequence without the axes that stand at their default. Cells that were measured before an axis was
// added and after it have the same, since the default is what was done before.
std::string shortKey(const std::string& key, const AxisValues& defaults);

// A reference whose own noise is above max_noise: what is scored against it proves nothing.
struct NoisyReference {
  std::string scene, camera;
  int frame = 0;
  double noise = 0;  // relMSE
};

// Whether the cell's reference is one of those; false where its floor or the limit is not known.
bool isTooNoisy(const CellResult& cell, const std::optional<double>& maxNoise);
// Each once, in the order of the cells, which share the reference of their frame.
std::vector<NoisyReference> findNoisyReferences(const std::vector<CellResult>& cells,
                                                const std::optional<double>& maxNoise);

struct Results {
  Provenance provenance;
  Tolerances tolerance;  // of the suite
  std::vector<CellResult> cells;
  Tolerances warnTolerance;              // of the suite: beyond these a change is reported
  SceneTolerances sceneTolerances;       // of its scenes that have their own
  std::vector<Attribution> attribution;  // of the cells that the suite asks it for
};

// JSON text with stable key order and shortest round-trip numbers, one cell a line; reading checks the whole document
// against the schema and throws one-sentence input Errors naming file (`place`) and JSON pointer. Both are inverse to
// each other.
std::string toJson(const Results& results);
Results resultsFromJson(const std::string& text, const std::string& place);

// Reads results.json of a run directory; an input Error if it is not there.
Results readResults(const std::string& runDirectory);

// One cell as a JSON object on one line, as it stands in results.json.
std::string toJson(const CellResult& cell);
CellResult cellFromJson(const std::string& text, const std::string& place);

// One tidy row per cell and value: scene,camera,frame,<axes>,region,metric,value (region: whole, mask, floor,
// mask_floor, unbiased, matched, matched_mask, cost, counter, material NAME, ...: docs/results.md). Undefined values
// are empty, infinity is "inf". defaults: of the axes; those that stand there in the whole run have no column.
std::string toCsv(const Results& results, const AxisValues& defaults = {});

}  // namespace pb
