// The answer of a run in ten lines.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <memory>

#include "bench/counted.h"
#include "bench/recommend.h"
#include "bench/recommend_text.h"
#include "bench/tables.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr std::size_t kMaxLines = 10;
// Good enough where nobody says what is: an error that is larger than the smallest one by a tenth.
constexpr double kGoodEnough = 1.1;
constexpr double kLeastShare = 0.005;  // smaller ones would be printed as 0 %

bool hasOwnTechniques(const Results& results) {
  return std::ranges::any_of(sectionsOf(results.cells), [](const Section& s) { return !s.sequences.empty(); });
}

// Of which an error is known.
bool hasChoice(const Results& results) {
  return hasOwnTechniques(results) && !candidatesOf(results, {}).candidates.empty();
}

// What the lines say, of a run or of one scene of it.
struct Findings {
  // The cheapest technique that is good enough; without costs, or where noise is not known, that of the smallest error.
  Recommendation answer;
  std::size_t best = 0;     // that of the smallest error, the cheapest of several
  std::string limit{};      // what is good enough, of the metric; empty where nobody can say
  bool byInterval = false;  // as nobody knows the smallest error to within a tenth
};

// What is nearly as good as that, rounded up to three digits: as it is printed, it must not refuse what it was made
// from.
double limitFor(const Estimate& loss) {
  constexpr double kSlack = 1e-9;  // relative, of the product: 1.1 * 0.19 is a little more than 0.209
  const double limit = std::max(kGoodEnough * loss.value, loss.high);
  if (!(limit > 0)) return limit;
  const double step = std::pow(10.0, std::floor(std::log10(limit)) - 2);
  const auto printed = [](double number) { return *parseNumber(formatSignificant(number)); };
  const double rounded = printed(step * std::ceil(limit / step * (1 - kSlack)));
  return rounded >= loss.high ? rounded : printed(rounded + step);
}

// Of results with techniques that can be compared; the results must outlive it.
Findings findingsOf(const Results& results) {
  RecommendRequest request;
  Findings findings{recommend(results, request)};
  findings.best = findings.answer.chosen.value();  // nothing limits it
  const Estimate loss = findings.answer.set.candidates[findings.best].loss;
  if (!loss.isKnown()) return findings;  // what is as good cannot be said
  findings.byInterval = loss.high > kGoodEnough * loss.value;
  request.maxError = limitFor(loss);
  findings.limit = formatSignificant(*request.maxError);
  if (findings.answer.front.empty()) return findings;  // no costs
  findings.answer = recommend(results, request);
  return findings;
}

std::string choiceText(const CandidateSet& set, std::size_t i, const std::string& metric) {
  const Candidate& candidate = set.candidates[i];
  return fmt::format("{} at {}, {}", techniqueText(candidate.technique, set), errorText(metric, candidate.loss),
                     ratioText(candidate));
}

// The largest shares first: "name 41 %, name 23 %".
std::string sharesText(std::vector<std::pair<std::string, double>> shares) {
  constexpr std::size_t kShown = 3;
  std::erase_if(shares, [](const auto& share) { return std::abs(share.second) < kLeastShare; });
  std::ranges::stable_sort(shares, std::greater(), [](const auto& share) { return std::abs(share.second); });
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < std::min(shares.size(), kShown); ++i)
    parts.push_back(fmt::format("{} {:.0f} %", shares[i].first, 100 * shares[i].second));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Which objects the error is of, in the last frame of the scene where it is largest.
std::string objectsText(const Candidate& candidate) {
  const CellResult& cell = *candidate.worstCells.back();
  std::vector<std::pair<std::string, double>> shares;
  for (const ObjectError& error : cell.objects) shares.emplace_back(error.object, error.share);
  if (shares.empty())
    for (const MaterialError& error : cell.materials) shares.emplace_back(error.material, error.share);
  const std::string text = sharesText(std::move(shares));
  if (text.empty()) return {};
  return fmt::format("Objects that show it ({} frame {}, share of the squared error): {}", cell.scene, cell.frame,
                     text);
}

std::ptrdiff_t agreeingAxes(const AxisValues& a, const AxisValues& b) {
  return std::ranges::count_if(a, [&](const auto& setting) { return std::ranges::find(b, setting) != b.end(); });
}

// That of the candidate where it is worst, at the last frame, or else of the technique that is most like it there, or
// else elsewhere.
const Attribution* attributionOf(const Results& results, const Candidate& candidate) {
  const auto rank = [&](const Attribution& a) {
    return std::pair(a.scene == candidate.worstScene, agreeingAxes(a.technique, candidate.technique));
  };
  const Attribution* best = nullptr;
  for (const Attribution& attribution : results.attribution)
    if (!best || rank(attribution) >= rank(*best)) best = &attribution;
  return best;
}

std::optional<double> errorOf(const AttributionStep& step, bool onMask) {
  for (const auto& [key, value] : onMask ? step.maskMetrics : step.metrics)
    if (key == Selection().metric) return value;
  return std::nullopt;
}

// Bars of the waterfall as shares of the whole error; they may be negative.
std::string attributionText(const Results& results, const CandidateSet& set, const Candidate& candidate) {
  const Attribution* attribution = attributionOf(results, candidate);
  if (!attribution || attribution->steps.empty()) return {};
  const bool onMask = !attribution->steps.back().maskMetrics.empty();
  const double total = errorOf(attribution->steps.back(), onMask).value_or(0);
  if (!(total > 0)) return {};
  std::vector<std::pair<std::string, double>> shares;
  double before = 0;
  for (const AttributionStep& step : attribution->steps) {
    const double error = errorOf(step, onMask).value_or(before);
    shares.emplace_back(step.step, (error - before) / total);
    before = error;
  }
  return fmt::format("Where the error of {} comes from ({} frame {}): {}", techniqueText(attribution->technique, set),
                     attribution->scene, attribution->frame, sharesText(std::move(shares)));
}

std::string withinText(const Findings& findings) {
  return findings.byInterval
             ? fmt::format("within its interval (at most {})", findings.limit)
             : fmt::format("within {:.0f} % of it (at most {})", 100 * (kGoodEnough - 1), findings.limit);
}

// The smallest error and the cheapest that is nearly as good, which may be the same.
std::vector<std::string> choiceLines(const Findings& findings) {
  const CandidateSet& set = findings.answer.set;
  const std::string best = choiceText(set, findings.best, Selection().metric);
  if (findings.answer.front.empty() || findings.limit.empty()) return {"Smallest error: " + best};
  const std::size_t cheapest = *findings.answer.chosen;
  if (cheapest == findings.best)
    return {fmt::format("Smallest error, and the cheapest {}: {}", withinText(findings), best)};
  return {"Smallest error: " + best,
          fmt::format("Cheapest {}: {}", withinText(findings), choiceText(set, cheapest, Selection().metric))};
}

std::vector<std::string> stepLines(const Findings& findings) {
  std::vector<std::string> lines;
  if (findings.answer.front.empty()) return lines;
  const std::vector<Step>& steps = findings.answer.steps;
  for (const Step* step : {bestStepUp(steps), bestStepDown(steps)})
    if (step) lines.push_back("From there, " + stepText(*step));
  return lines;
}

std::vector<std::string> sourceLines(const Results& results, const Findings& findings) {
  const CandidateSet& set = findings.answer.set;
  const Candidate& answer = set.candidates[*findings.answer.chosen];
  std::vector<std::string> lines = {attributionText(results, set, answer), objectsText(answer)};
  std::erase(lines, "");
  return lines;
}

void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

std::vector<std::string> linesOf(const Results& results, const PrintSettings& settings) {
  const Findings findings = findingsOf(results);
  const CandidateSet& set = findings.answer.set;
  std::vector<std::string> lines = {fmt::format(
      "{} on {}; error: {}{}; cost: frame time over that of a plain frame", counted(set.candidates.size(), "technique"),
      counted(set.scenes.size(), "scene"), questionText({}, set), set.scenes.size() == 1 ? "" : ", worst scene")};
  append(lines, sourceLines(results, findings));
  append(lines, choiceLines(findings));
  append(lines, stepLines(findings));
  if (findings.answer.front.empty()) return lines;
  if (findings.answer.knee)
    lines.push_back("Knee, after which more time buys less: " +
                    choiceText(set, *findings.answer.knee, Selection().metric));
  lines.push_back(
      fmt::format("Other limits: probebench recommend {} --max-error {}={} | --budget-ms Y | --budget-ratio Y",
                  settings.runDirectory, Selection().metric, findings.limit.empty() ? "X" : findings.limit));
  return lines;
}

// --- Where the techniques differ from scene to scene, each scene has its own answer.

struct SceneFindings {
  std::string scene;
  Results part;  // of that scene alone
  std::optional<Findings> findings{};

  double smallestError() const { return findings->answer.set.candidates[findings->best].loss.value; }
};

// By error, the largest first; a scene without a technique to name is left out.
std::vector<std::unique_ptr<SceneFindings>> findByScene(const Results& results) {
  std::map<std::string, std::unique_ptr<SceneFindings>> scenes;
  for (const CellResult& cell : results.cells) {
    std::unique_ptr<SceneFindings>& scene = scenes[cell.scene];
    if (!scene) scene = std::make_unique<SceneFindings>(SceneFindings{cell.scene, {}});
    scene->part.cells.push_back(cell);
  }
  std::vector<std::unique_ptr<SceneFindings>> found;
  for (auto& [name, scene] : scenes) {
    if (!hasChoice(scene->part)) continue;
    std::ranges::copy_if(results.attribution, std::back_inserter(scene->part.attribution),
                         [&](const Attribution& attribution) { return attribution.scene == name; });
    scene->findings = findingsOf(scene->part);
    found.push_back(std::move(scene));
  }
  std::ranges::stable_sort(found, std::greater(), [](const auto& scene) { return scene->smallestError(); });
  return found;
}

std::string sceneLine(const SceneFindings& scene) {
  const Findings& findings = *scene.findings;
  const CandidateSet& set = findings.answer.set;
  std::string line =
      fmt::format("{}: smallest error {}", scene.scene, choiceText(set, findings.best, Selection().metric));
  if (*findings.answer.chosen != findings.best)
    line += fmt::format("; cheapest {}: {}", withinText(findings),
                        choiceText(set, *findings.answer.chosen, Selection().metric));
  return line;
}

// What is most important first, as there may be room for the first few only.
std::vector<std::string> linesOf(const SceneFindings& scene, std::size_t room) {
  const std::vector<std::string> steps = stepLines(*scene.findings);
  if (room == 1) return {sceneLine(scene) + (steps.empty() ? "" : "; " + steps.front())};
  std::vector<std::string> lines = {sceneLine(scene)};
  std::vector<std::string> details = sourceLines(scene.part, *scene.findings);
  details.insert(details.begin() + (details.empty() ? 0 : 1), steps.begin(), steps.end());
  for (std::size_t i = 0; i < std::min(details.size(), room - 1); ++i) lines.push_back("  " + details[i]);
  return lines;
}

std::vector<std::string> linesByScene(const Results& results, const PrintSettings& settings) {
  const auto scenes = findByScene(results);
  if (scenes.empty()) return {};
  const bool all = scenes.size() < kMaxLines;
  const std::size_t shown = all ? scenes.size() : kMaxLines - 2;
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < shown; ++i) append(lines, linesOf(*scenes[i], (kMaxLines - 1) / shown));
  if (!all) lines.push_back(fmt::format("and {} with smaller errors", counted(scenes.size() - shown, "scene")));
  lines.push_back(
      fmt::format("One scene: probebench recommend {} --scene NAME --max-error flip_hdr=X", settings.runDirectory));
  return lines;
}

}  // namespace

std::vector<std::string> summaryLines(const Results& results, const PrintSettings& settings) {
  if (!hasOwnTechniques(results)) return {};
  const CandidateSet set = candidatesOf(results, {});
  if (set.candidates.size() < 2 && set.elsewhere > 0) return linesByScene(results, settings);
  if (set.candidates.empty()) return {};
  return linesOf(results, settings);
}

}  // namespace pb
