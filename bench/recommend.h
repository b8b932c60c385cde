// Decisions from a run: which technique is the cheapest that is good enough, which are worth their cost, and what the
// next step buys. Pure functions of results.
//
// Several scenes: a technique counts only if it was measured on all of them, with the error and the cost of the scene
// where each is largest. Costs are frame times, in ms or as a multiple of a plain frame (the same scene and size with
// reflections of the environment only).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/candidates.h"
#include "bench/results.h"
#include "bench/verdict.h"

namespace pb {

struct RecommendRequest {
  Selection selection;                // metric, scenes, object
  std::optional<double> maxError;     // of the metric; a lower limit where more is better
  std::optional<double> budgetMs;     // of a frame
  std::optional<double> budgetRatio;  // frame over plain frame
  std::optional<double> budgetMb;     // probe memory, 10^6 bytes
};

// What going from one technique to another does, where they differ in one axis.
struct Step {
  std::string axis, from, to;
  Estimate gain{};                   // by which the error falls, negative if it rises; paired if it can be
  std::optional<Verdict> verdict{};  // of the error after it, seen from that before; nullopt: the noise is not known
  std::optional<Estimate> costFactor{};
};

struct Recommendation {
  CandidateSet set;
  std::optional<std::size_t> chosen;   // index into set.candidates
  std::vector<std::size_t> undecided;  // would be better, but lie within their interval of a limit
  std::vector<std::size_t> front;      // Pareto front of error and cost, cheapest first; empty without costs
  std::optional<std::size_t> knee;
  std::vector<Step> steps;  // from the chosen one, to the nearest value either way of each axis
};

// With maxError the cheapest whose interval lies below it and within the budgets; without, the one of smallest error
// within the budgets. Throws input Errors: unknown metric or object, a pattern that matches no scene, a budget or
// maxError where no cost was measured.
Recommendation recommend(const Results& results, const RecommendRequest& request);

// Steps from a candidate to those that differ in one axis only; numbers go to the next smaller and larger one.
std::vector<Step> stepsFrom(const CandidateSet& set, std::size_t candidate);

struct PrintSettings {
  std::string runDirectory = "RUN_DIR";  // as it was named on the command line
  AxisValues defaults;                   // of the axes: those that stand there need no words
};

// The answer with its Pareto front, next steps, and the command that measures it alone.
std::string print(const Recommendation& recommendation, const RecommendRequest& request, const Results& results,
                  const PrintSettings& settings);

// `probebench run ...` of the cells of a technique on these scenes, with the suite and options of the run.
inline constexpr char kCommandSetting[] = "command";  // of Provenance::settings: the run's own, where it is known
std::string rerunCommand(const Results& results, const AxisValues& technique, const std::vector<std::string>& scenes);

// At most ten lines for the end of a run and the head of a report: where the error comes from, the cheapest setting
// that is good enough, what the next step buys. Without line breaks; empty where there is nothing to say.
std::vector<std::string> summaryLines(const Results& results, const PrintSettings& settings = {});

}  // namespace pb
