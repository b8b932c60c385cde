// What a plan comes to, and how long that should take by rates that earlier runs measured.
//
// Units of work are pixels that are shaded, in millions, with a constant for each render and each scored picture:
// crude, but the rates are kept by scene, so that they only have to hold from one run of a scene to the next.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/plan.h"
#include "bench/progress.h"
#include "bench/runner.h"
#include "bench/store.h"
#include "bench/suite.h"

namespace pb {

// A part of a run that has its own rate: "references", "errors", "cost", ... and its scene, or its suite where it is of
// all scenes.
using WorkKind = std::pair<std::string, std::string>;

struct PlanWork {
  std::string suite;
  std::size_t references = 0;  // distinct pictures: frames of scenes, at the depths that are asked for
  std::size_t stored = 0;      // of those
  std::size_t frames = 0;      // final images that the rasteriser renders for errors, of all sequences
  std::size_t sharing = 0;     // of those: from captures of another sequence's (bench/capture_groups.h)
  double captures = 0;         // faces of cubes that are captured for them, by the cost model
  std::size_t blocks = 0;      // cost measurements times repetitions
  bool mayRefine = false;      // max_noise may ask for more than one picture a reference
  std::map<WorkKind, double> units;

  // Of attributions, each once (bench/attribution_renders.h): images, and the sets of maps that they show.
  struct {
    std::size_t images = 0, traced = 0, captured = 0;
  } attribution{};

  // --until-decided scores what gets intervals before that, at least once (bench/until_decided.h). It renders nothing
  // that a run without it would not.
  bool untilDecided = false;
};

// Loads nothing; evaluates the scenes at the frames of the plan.
PlanWork computeWork(const Suite& suite, const Scenes& scenes, const Plan& plan, const ReferenceStore& store);

// Seconds a unit, measured in earlier runs on the same machine; a JSON file beside the stored references. Unreadable
// files count as empty.
class Rates {
 public:
  Rates(const std::filesystem::path& folder, std::string machine);

  // Of the scene or suite, else the mean over all of them; nullopt if the kind was never measured here.
  std::optional<double> secondsPerUnit(const WorkKind& kind) const;

  // The last measurement of a kind and scene counts, unless it was of less than half of the work of the one before:
  // small runs tell little.
  void record(const WorkKind& kind, double units, double seconds);
  // Phases of a run that did all of its work (not a resumed one).
  void record(const std::vector<Phase>& phases, const PlanWork& work);
  void save() const;  // where the folder can be written

 private:
  struct Measured {
    double units = 0, seconds = 0;
  };
  std::filesystem::path file_;
  std::string machine_;
  std::map<std::string, std::map<WorkKind, Measured>> measured_;  // by machine
};

// "errors of pool" is the kind ("errors", "pool"), "cost" that of the suite.
WorkKind kindOfPhase(const std::string& phase, const std::string& suite);

// What will be rendered and how long it should take, for --dry-run and the start of a run.
std::string printWork(const PlanWork& work, const Rates& rates);

}  // namespace pb
