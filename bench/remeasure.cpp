#include "bench/remeasure.h"

#include <algorithm>

#include "bench/axes.h"
#include "bench/cost.h"
#include "bench/cost_request.h"
#include "bench/hash.h"
#include "bench/provenance.h"
#include "scenes/error.h"

namespace pb {
namespace {

void requireSameSuite(const Results& run, const Suite& now, const std::string& suite) {
  if (run.provenance.suiteHash != hexHash(canonicalText(now)))
    throwInputError(
        "the run is not one of suite '{}' as it is now and without other options: run it again into another "
        "folder and give that to --confirm",
        suite);
}

void requireSameScenes(const Results& run, const Provenance& now) {
  for (const auto& [scene, hash] : now.sceneHashes)
    if (const auto then = run.provenance.sceneHashes.find(scene);
        then != run.provenance.sceneHashes.end() && then->second != hash)
      throwInputError("scene '{}' has changed since the run", scene);
}

}  // namespace

std::vector<CellResult> remeasureCosts(const CostPlace& place, const std::vector<std::string>& sequences,
                                       const AxisValues& defaults, Progress& progress) {
  std::vector<CostRequest> requests;
  std::vector<CellResult> cells;
  for (const PlannedSequence& sequence : makePlan(place.suite).sequences) {
    CellResult cell = makeCell(place.suite, sequence, sequence.frames.back());
    if (sequence.external || std::ranges::find(sequences, shortKey(cell.sequenceKey(), defaults)) == sequences.end())
      continue;
    requests.push_back(makeCostRequest(place.suite, place.scenes, sequence));
    cells.push_back(std::move(cell));
  }
  if (requests.empty()) return {};
  progress.begin("cost again", requests.size());
  const CostRun measured = measureCosts(place.device, place.suite.image, requests, place.suite.cost.repetitions, {},
                                        [&] { progress.step(); });
  progress.end();
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].cost = measured.results[i];
  return cells;
}

void requireRunOf(const Results& run, const std::string& suiteName) {
  Suite suite = loadSuite(suiteName);
  loadScenes(suite);  // names the cameras, which are part of what is compared
  requireSameSuite(run, suite, suiteName);
}

Results remeasureRun(const Results& run, const std::string& suiteName, const std::vector<std::string>& sequences,
                     GlBackend backend, int threads) {
  Suite suite = loadSuite(suiteName);
  const Scenes scenes = loadScenes(suite);
  requireSameSuite(run, suite, suiteName);
  RasterDevice device(backend);
  Results rerun;
  rerun.provenance = makeProvenance(suite, scenes, device.info(), threads);
  requireSameScenes(run, rerun.provenance);
  Progress progress;
  rerun.cells = remeasureCosts({suite, scenes, device}, sequences, describe(Technique{}), progress);
  return rerun;
}

}  // namespace pb
