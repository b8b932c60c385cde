// Runs a plan: references, then errors (rasterising on the calling thread, metrics of earlier cells beside it), then
// cost with nothing else running. Results do not depend on the order in which cells finish.
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

namespace pb {

using Scenes = std::vector<std::shared_ptr<const Scene>>;  // one a scene of the suite

// Loads the suite's scenes and puts the name of a scene's first camera where the suite names none.
Scenes loadScenes(Suite& suite);

// Throws if the program of an external technique can't be found or a picture that was made earlier is not there: what
// is sure to fail fails before anything is rendered.
void requireExternals(const Suite& suite, const Scenes& scenes, const Plan& plan);

struct RunContext {
  const Suite& suite;
  const Scenes& scenes;
  const Plan& plan;
  RasterDevice& device;
  const ReferenceStore& store;
  RunDirectory& directory;
  Progress& progress;
};

struct RunOutcome {
  std::vector<CellResult> cells;  // in the plan's order
  std::vector<Attribution> attribution;
  std::string benchmarkJson;  // empty if no cost was measured
  // External techniques that could not take a scene's job: "external NAME on SCENE" and why, one a pair.
  std::vector<std::pair<std::string, std::string>> skipped;
  std::vector<std::string> noisyReferences;  // those that missed max_noise: one sentence each
};

// Throws Error(Failure::interrupted) at a cell boundary after an interrupt; what is done stands in the journal.
RunOutcome runPlan(const RunContext& context);

// Throws the input Errors with which a technique would refuse its scene, before anything is rendered.
void checkPlan(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device);

}  // namespace pb
