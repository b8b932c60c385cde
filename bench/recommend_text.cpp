#include "bench/recommend_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "bench/counted.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr double kBytesPerMegabyte = 1e6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string megabytesText(double bytes) { return formatSignificant(bytes / kBytesPerMegabyte) + " MB"; }

std::string namedTechnique(const AxisValues& technique, const CandidateSet& set, const AxisValues& defaults) {
  if (!set.axes.empty()) return techniqueText(technique, set);
  std::string text;
  for (const auto& setting : technique)
    if (std::ranges::find(defaults, setting) == defaults.end())
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", setting.first, setting.second);
  return text.empty() ? "every axis at its default" : text;
}

// What techniqueText() leaves out, unless it is the default.
std::string commonText(const CandidateSet& set, const AxisValues& defaults) {
  AxisValues common = set.common;
  std::erase_if(common, [&](const auto& setting) { return std::ranges::find(defaults, setting) != defaults.end(); });
  std::string text;
  for (const auto& [axis, value] : common) text += fmt::format(" {}={}", axis, value);
  if (set.common.empty()) return {};
  return fmt::format(
      "Where a technique doesn't say otherwise:{}{}\n", text,
      common.size() < set.common.size() ? (text.empty() ? " defaults" : ", other axes at their defaults") : "");
}

std::string limitsText(const RecommendRequest& request) {
  std::vector<std::string> limits;
  const std::string& metric = request.selection.metric;
  const bool more = lossOf(metric, 1.0) < 0;
  if (request.maxError) limits.push_back(fmt::format("{} {} {:g}", metric, more ? ">=" : "<=", *request.maxError));
  if (request.budgetMs) limits.push_back(fmt::format("at most {:g} ms a frame", *request.budgetMs));
  if (request.budgetRatio) limits.push_back(fmt::format("at most {:g} times a plain frame", *request.budgetRatio));
  if (request.budgetMb) limits.push_back(fmt::format("at most {:g} MB of probes", *request.budgetMb));
  return limits.empty() ? "no limit" : fmt::format("{}", fmt::join(limits, ", "));
}

std::string scenesText(const CandidateSet& set) {
  if (set.scenes.size() == 1) return set.scenes.front();
  return fmt::format("{} scenes, of which the worst counts", set.scenes.size());
}

std::string candidateText(const Candidate& candidate, const RecommendRequest& request, const CandidateSet& set) {
  std::string text =
      fmt::format("  {} {}", request.selection.metric, errorText(request.selection.metric, candidate.loss));
  if (set.scenes.size() > 1) text += fmt::format(" (on {})", candidate.worstScene);
  if (!candidate.clearOfFloor) text += ", not clear of the reference's noise";
  text += fmt::format("\n  {}", ratioText(candidate, true));
  if (candidate.frameMs) text += fmt::format(" of a plain frame, {} ms", formatSignificant(candidate.frameMs->value));
  return text + fmt::format(", {} of probes\n", megabytesText(candidate.probeBytes));
}

std::string frontText(const Recommendation& answer, const RecommendRequest& request, const AxisValues& defaults) {
  if (answer.front.empty()) return {};
  Table table{{{"", Align::left},
               {"technique", Align::left},
               {request.selection.metric},
               {"x plain"},
               {"95 %"},
               {"ms"},
               {"probes"}},
              {}};
  for (const std::size_t i : answer.front) {
    const Candidate& c = answer.set.candidates[i];
    const bool costs = c.ratio.has_value();
    table.rows.push_back(
        {i == answer.chosen ? "*"
         : i == answer.knee ? "knee"
                            : "",
         namedTechnique(c.technique, answer.set, defaults), errorText(request.selection.metric, c.loss),
         costs ? formatSignificant(c.ratio->value) : "-",
         costs ? fmt::format("{}..{}", formatSignificant(c.ratio->low), formatSignificant(c.ratio->high)) : "-",
         c.frameMs ? formatSignificant(c.frameMs->value) : "-", megabytesText(c.probeBytes)});
  }
  return fmt::format("Pareto front of error and cost (* the answer):\n\n{}\n", toMarkdown(table));
}

std::string undecidedText(const Recommendation& answer, const RecommendRequest& request, const AxisValues& defaults) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(answer.undecided.size(), kShown); ++i) {
    const Candidate& c = answer.set.candidates[answer.undecided[i]];
    text += fmt::format("{}, so not sure: {}, {} {}, {}\n",
                        c.loss.isKnown() ? "Within its interval of a limit" : "Within the limits as measured",
                        namedTechnique(c.technique, answer.set, defaults), request.selection.metric,
                        errorText(request.selection.metric, c.loss), ratioText(c));
  }
  return text;
}

std::string stepsText(const std::vector<Step>& steps) {
  constexpr std::size_t kShown = 8;
  if (steps.empty()) return {};
  std::vector<Step> sorted = steps;
  std::ranges::stable_sort(sorted, std::greater(), [](const Step& step) { return step.gain.value; });
  std::string text = "One step from there:\n";
  for (std::size_t i = 0; i < std::min(sorted.size(), kShown); ++i) text += "  " + stepText(sorted[i]) + '\n';
  return text + '\n';
}

// What would have been the nearest to an answer, in each respect that was asked for.
std::string nothingText(const Recommendation& answer, const RecommendRequest& request, const AxisValues& defaults) {
  const auto& candidates = answer.set.candidates;
  if (candidates.empty()) return "No technique was measured on all of these scenes.\n";
  std::string text = answer.undecided.empty() ? "No technique of this run holds that."
                                              : "No technique of this run holds that for sure.";
  const auto add = [&](const char* what, const auto& rank) {
    const Candidate& nearest = *std::ranges::min_element(candidates, {}, rank);
    text += fmt::format(" The {}: {}\n{}", what, namedTechnique(nearest.technique, answer.set, defaults),
                        candidateText(nearest, request, answer.set));
  };
  const auto cost = [](const Candidate& c) { return c.ratio ? c.ratio->value : kInfinity; };
  const auto ms = [](const Candidate& c) { return c.frameMs ? c.frameMs->value : kInfinity; };
  if (request.maxError) add("smallest error", [&](const Candidate& c) { return std::pair(c.loss.value, cost(c)); });
  if (request.budgetMs) add("shortest frames", [&](const Candidate& c) { return std::pair(ms(c), c.loss.value); });
  if (request.budgetRatio) add("cheapest", [&](const Candidate& c) { return std::pair(cost(c), c.loss.value); });
  if (request.budgetMb)
    add("smallest probes", [](const Candidate& c) { return std::pair(c.probeBytes, c.loss.value); });
  return text;
}

}  // namespace

std::string errorText(const std::string& metric, const Estimate& loss) {
  const Estimate error = isLowerBetter(metric) ? loss : -loss;
  return formatSignificant(error.value) + formatUncertainty(error);
}

std::string ratioText(const Candidate& candidate, bool withInterval) {
  if (!candidate.ratio) return "no cost measured";
  const std::string value = formatSignificant(candidate.ratio->value) + "x";
  if (!withInterval) return value;
  return fmt::format("{} [{}, {}]", value, formatSignificant(candidate.ratio->low),
                     formatSignificant(candidate.ratio->high));
}

std::string questionText(const Selection& selection, const CandidateSet& set) {
  std::string text = selection.metric;
  if (!selection.object.empty())
    text += fmt::format(" of '{}'", selection.object);
  else
    text += set.onMask ? " on mirrors and glass" : " on the whole image";
  return text + (selection.worstFrame ? ", worst frame" : ", mean over the frames");
}

std::string stepText(const Step& step) {
  const double reach = step.gain.isKnown() ? step.gain.plusMinus() : 0;
  std::string text = fmt::format("{} {} -> {} ", step.axis, step.from, step.to);
  if (step.verdict == Verdict::belowFloor)
    text += "stays below the floor";
  else if (step.verdict == Verdict::equal)
    text += reach > 0 ? "changes nothing within " + formatSignificant(reach, 1) : "changes nothing";
  else if (step.gain.value > 0)
    text += fmt::format("buys {}{}", formatSignificant(step.gain.value), formatUncertainty(step.gain));
  else
    text += fmt::format("loses {}{}", formatSignificant(-step.gain.value), formatUncertainty(-step.gain));
  if (!step.costFactor) return text;
  const bool sure = step.costFactor->high < 1 || step.costFactor->low > 1;
  return text + (sure ? fmt::format(" for {}x the time", formatSignificant(step.costFactor->value))
                      : " for the same time within its interval");
}

const Step* bestStepUp(const std::vector<Step>& steps) {
  const Step* best = nullptr;
  for (const Step& step : steps)
    if (step.verdict == Verdict::better && (!best || step.gain.value > best->gain.value)) best = &step;
  return best;
}

const Step* bestStepDown(const std::vector<Step>& steps) {
  const Step* best = nullptr;
  const auto loss = [](const Step& step) {
    const bool mayCost = !step.verdict || step.verdict == Verdict::worse;
    return mayCost ? std::max(-step.gain.value, 0.0) : 0.0;
  };
  for (const Step& step : steps) {
    if (!step.costFactor || !(step.costFactor->high < 1)) continue;
    const bool better = !best || loss(step) < loss(*best) ||
                        (loss(step) == loss(*best) && step.costFactor->value < best->costFactor->value);
    if (better) best = &step;
  }
  return best;
}

std::string print(const Recommendation& answer, const RecommendRequest& request, const Results& results,
                  const PrintSettings& settings) {
  std::string text = fmt::format("{}; {}; {}\n", limitsText(request), questionText(request.selection, answer.set),
                                 scenesText(answer.set));
  text += counted(answer.set.candidates.size(), "technique") + " compared";
  if (answer.set.elsewhere > 0)
    text += fmt::format("; {} more were measured on some of these scenes only (--scene chooses)", answer.set.elsewhere);
  text += '\n' + commonText(answer.set, settings.defaults) + '\n';
  if (!answer.chosen)
    return text + nothingText(answer, request, settings.defaults) + undecidedText(answer, request, settings.defaults) +
           '\n' + frontText(answer, request, settings.defaults);
  const Candidate& chosen = answer.set.candidates[*answer.chosen];
  text += fmt::format("{}: {}\n{}", request.maxError ? "Cheapest" : "Smallest error",
                      namedTechnique(chosen.technique, answer.set, settings.defaults),
                      candidateText(chosen, request, answer.set));
  text += undecidedText(answer, request, settings.defaults) + '\n';
  text += stepsText(answer.steps);
  if (answer.knee)
    text += fmt::format("Knee of the front, after which more time buys less: {}\n\n",
                        namedTechnique(answer.set.candidates[*answer.knee].technique, answer.set, settings.defaults));
  text += frontText(answer, request, settings.defaults);
  return text +
         fmt::format("Measure the answer alone:\n  {}\n", rerunCommand(results, chosen.technique, answer.set.scenes));
}

}  // namespace pb
