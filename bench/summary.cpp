// The answer of a run in ten lines.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "bench/recommend.h"
#include "bench/recommend_text.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr std::size_t kMaxLines = 10;
// Good enough where nobody says what is: an error that is larger than the smallest one by a tenth.
constexpr double kGoodEnough = 1.1;

std::size_t bestOf(const CandidateSet& set) {
  const auto loss = [](const Candidate& candidate) { return candidate.loss.value; };
  return static_cast<std::size_t>(std::ranges::min_element(set.candidates, {}, loss) - set.candidates.begin());
}

std::optional<std::size_t> cheapestGoodEnough(const CandidateSet& set, std::size_t best) {
  const double limit = kGoodEnough * set.candidates[best].loss.value;
  std::optional<std::size_t> cheapest;
  for (std::size_t i = 0; i < set.candidates.size(); ++i) {
    const Candidate& candidate = set.candidates[i];
    if (!candidate.ratio || !(candidate.loss.value <= limit)) continue;
    if (!cheapest || candidate.ratio->value < set.candidates[*cheapest].ratio->value) cheapest = i;
  }
  return cheapest;
}

std::string choiceText(const CandidateSet& set, std::size_t i, const std::string& metric) {
  const Candidate& candidate = set.candidates[i];
  return fmt::format("{} at {}, {}", techniqueText(candidate.technique, set), errorText(metric, candidate.loss),
                     ratioText(candidate));
}

// The largest shares first: "name 41 %, name 23 %".
std::string sharesText(std::vector<std::pair<std::string, double>> shares) {
  constexpr std::size_t kShown = 3;
  std::ranges::stable_sort(shares, std::greater(), [](const auto& share) { return std::abs(share.second); });
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < std::min(shares.size(), kShown); ++i)
    if (shares[i].second != 0) parts.push_back(fmt::format("{} {:.0f} %", shares[i].first, 100 * shares[i].second));
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

// That of the candidate where it is worst, or else of any technique on that scene, or else the first.
const Attribution* attributionOf(const Results& results, const Candidate& candidate) {
  const Attribution* best = nullptr;
  const auto rank = [&](const Attribution& a) {
    return (a.scene == candidate.worstScene ? 2 : 0) + (a.technique == candidate.technique ? 1 : 0);
  };
  for (const Attribution& attribution : results.attribution)
    if (!best || rank(attribution) > rank(*best)) best = &attribution;
  return best;
}

std::optional<double> errorOf(const AttributionStep& step, bool onMask) {
  for (const auto& [key, value] : onMask ? step.maskMetrics : step.metrics)
    if (key == Selection().metric) return value;
  return std::nullopt;
}

// Bars of the waterfall as shares of the whole error; they may be negative.
std::string attributionText(const Results& results, const Candidate& candidate) {
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
  const bool same = attribution->technique == candidate.technique;
  return fmt::format("Where the error comes from ({} frame {}{}): {}", attribution->scene, attribution->frame,
                     same ? "" : ", another technique", sharesText(std::move(shares)));
}

std::string limitText(const std::string& metric, const Estimate& loss) {
  return fmt::format("{}={}", metric, formatSignificant(metricOfLoss(metric, kGoodEnough * loss.value), 2));
}

std::vector<std::string> linesOf(const Results& results, const CandidateSet& set, const PrintSettings& settings) {
  const Selection selection;
  const std::size_t best = bestOf(set);
  const std::optional<std::size_t> cheapest = cheapestGoodEnough(set, best);
  const Candidate& answer = set.candidates[cheapest.value_or(best)];
  std::vector<std::string> lines = {
      fmt::format("{} techniques on {} scene{}; error: {}{}; cost: frame time over that of a plain frame",
                  set.candidates.size(), set.scenes.size(), set.scenes.size() == 1 ? "" : "s",
                  questionText(selection, set), set.scenes.size() == 1 ? "" : ", worst scene")};
  for (const std::string& source : {attributionText(results, answer), objectsText(answer)})
    if (!source.empty()) lines.push_back(source);
  lines.push_back(fmt::format("Smallest error: {}", choiceText(set, best, selection.metric)));
  if (!cheapest) return lines;
  lines.push_back(fmt::format("Cheapest within {:.0f} % of it: {}", 100 * (kGoodEnough - 1),
                              choiceText(set, *cheapest, selection.metric)));
  const std::vector<Step> steps = stepsFrom(set, *cheapest);
  if (const Step* up = bestStepUp(steps)) lines.push_back("From there, " + stepText(*up));
  if (const Step* down = bestStepDown(steps)) lines.push_back("From there, " + stepText(*down));
  const Recommendation whole = recommend(results, {});
  if (whole.knee)
    lines.push_back("Knee, after which more time buys less: " + choiceText(set, *whole.knee, selection.metric));
  lines.push_back(fmt::format("Other limits: probebench recommend {} --max-error {} | --budget-ms Y | --budget-ratio Y",
                              settings.runDirectory, limitText(selection.metric, set.candidates[best].loss)));
  return lines;
}

// Where the techniques differ from scene to scene, each scene has its own answer.
std::string sceneLine(const Results& results, const std::string& scene) {
  std::vector<CellResult> cells;
  std::ranges::copy_if(results.cells, std::back_inserter(cells),
                       [&](const CellResult& cell) { return cell.scene == scene; });
  Results part;
  part.cells = std::move(cells);
  const Selection selection;
  const CandidateSet set = candidatesOf(part, selection);
  if (set.candidates.empty()) return {};
  const std::size_t best = bestOf(set);
  std::string line = fmt::format("{}: smallest error {}", scene, choiceText(set, best, selection.metric));
  const std::optional<std::size_t> cheapest = cheapestGoodEnough(set, best);
  if (cheapest && *cheapest != best)
    line += fmt::format("; cheapest within {:.0f} %: {}", 100 * (kGoodEnough - 1),
                        choiceText(set, *cheapest, selection.metric));
  return line;
}

std::vector<std::string> linesByScene(const Results& results, const PrintSettings& settings) {
  std::vector<std::string> scenes;
  for (const CellResult& cell : results.cells)
    if (std::ranges::find(scenes, cell.scene) == scenes.end()) scenes.push_back(cell.scene);
  const std::size_t shown = std::min(scenes.size(), kMaxLines - 2);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < shown; ++i)
    if (const std::string line = sceneLine(results, scenes[i]); !line.empty()) lines.push_back(line);
  if (lines.empty()) return lines;
  if (shown < scenes.size()) lines.push_back(fmt::format("and {} more scenes", scenes.size() - shown));
  lines.push_back(
      fmt::format("One scene: probebench recommend {} --scene NAME --max-error flip_hdr=X", settings.runDirectory));
  return lines;
}

bool hasOwnTechniques(const Results& results) {
  return std::ranges::any_of(sectionsOf(results.cells), [](const Section& s) { return !s.sequences.empty(); });
}

}  // namespace

std::vector<std::string> summaryLines(const Results& results, const PrintSettings& settings) {
  if (!hasOwnTechniques(results)) return {};
  const CandidateSet set = candidatesOf(results, {});
  if (set.candidates.size() < 2 && set.elsewhere > 0) return linesByScene(results, settings);
  if (set.candidates.empty()) return {};
  return linesOf(results, set, settings);
}

}  // namespace pb
