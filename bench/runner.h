// Runs a plan: references and errors (bench/error_runner.h), intervals, attribution, then cost with nothing else
// running. Results do not depend on the order in which cells finish. Pictures that the run's folder keeps already
// (bench/kept_pictures.h) are taken from there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/plan.h"
#include "bench/progress.h"
#include "bench/results.h"
#include "bench/run_directory.h"
#include "bench/store.h"
#include "bench/suite.h"
#include "raster/renderer.h"
#include "scenes/snapshot.h"

namespace pb {

using Scenes = std::vector<std::shared_ptr<const Scene>>;  // one a scene of the suite

// Loads the suite's scenes and puts the name of a scene's first camera where the suite names none.
Scenes loadScenes(Suite& suite);

struct RunContext {
  const Suite& suite;
  const Scenes& scenes;
  const Plan& plan;
  RasterDevice& device;
  const ReferenceStore& store;
  RunDirectory& directory;
  Progress& progress;
};

// Of a scene of the suite, through its camera. Frames before 0 show frame 0: warm-up of a scene that stands still until
// then.
std::shared_ptr<const Snapshot> makeSnapshot(const RunContext& context, std::size_t scene, int frame);

// External techniques that could not take a scene's job: "external NAME on SCENE" and why, one a pair.
using SkippedExternals = std::vector<std::pair<std::string, std::string>>;

struct RunOutcome {
  std::vector<CellResult> cells;  // in the plan's order
  std::vector<Attribution> attribution;
  std::string benchmarkJson;  // empty if no cost was measured
  SkippedExternals skipped;
  std::vector<std::string> noisyReferences;  // those that missed max_noise: one sentence each
};

// skipped: external techniques that are known not to take the job, and aren't asked again. Throws
// Error(Failure::interrupted) at a cell boundary after an interrupt; what is done stands in the journal.
RunOutcome runPlan(const RunContext& context, const SkippedExternals& skipped = {});

}  // namespace pb
