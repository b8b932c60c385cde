#include "bench/runner.h"

#include <algorithm>
#include <cassert>
#include <map>

#include "bench/attribution_runner.h"
#include "bench/cost.h"
#include "bench/cost_request.h"
#include "bench/error_runner.h"
#include "bench/interval_runner.h"
#include "bench/truth.h"
#include "bench/version.h"

namespace pb {
namespace {

class Runner {
 public:
  Runner(const RunContext& context, const SkippedExternals& skipped) : c_(context), skipped_(skipped) {
    for (const CellResult& cell : c_.directory.finishedCells()) finished_.emplace(cell.key(), cell);
  }

  RunOutcome run() {
    RunOutcome outcome;
    outcome.skipped = skipped_ = measureErrors(c_, finished_, skipped_);
    outcome.cells = orderedCells();
    addIntervals(c_, outcome.cells);
    outcome.attribution = attribute(c_, outcome.cells);
    if (c_.suite.cost.repetitions > 0) outcome.benchmarkJson = measureCost(outcome.cells);
    outcome.noisyReferences = describeNoisyReferences(outcome.cells, c_.suite.reference);
    return outcome;
  }

 private:
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
  FinishedCells finished_;
  SkippedExternals skipped_;
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

std::shared_ptr<const Snapshot> makeSnapshot(const RunContext& context, std::size_t scene, int frame) {
  const Suite& suite = context.suite;
  return makeSnapshot(context.scenes[scene], std::max(frame, 0), suite.scenes[scene].camera, suite.image.aspect());
}

RunOutcome runPlan(const RunContext& context, const SkippedExternals& skipped) {
  return Runner(context, skipped).run();
}

}  // namespace pb
