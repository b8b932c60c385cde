#include "bench/recommend.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

struct RecommendOptions {
  std::string run, maxError, metric, region;
  RecommendRequest request;
};

// "flip_hdr=0.05"
void setMaxError(const std::string& text, RecommendRequest& request) {
  const std::size_t equals = text.find('=');
  const std::optional<double> limit =
      equals == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(equals + 1));
  if (!limit) throwInputError("--max-error wants METRIC=X, got '{}'", text);
  request.selection.metric = text.substr(0, equals);
  request.maxError = *limit;
}

RecommendRequest requestOf(const RecommendOptions& options) {
  RecommendRequest request = options.request;
  if (!options.metric.empty()) request.selection.metric = options.metric;
  if (!options.maxError.empty()) setMaxError(options.maxError, request);
  if (!options.metric.empty() && options.metric != request.selection.metric)
    throwInputError("--metric and --max-error name different metrics, '{}' and '{}'", options.metric,
                    request.selection.metric);
  if (!options.region.empty()) request.selection.region = options.region == "mask" ? Region::mask : Region::whole;
  if (!request.maxError && !request.budgetMs && !request.budgetRatio && !request.budgetMb)
    throwInputError("recommend wants a limit: --max-error METRIC=X, --budget-ms, --budget-ratio or --budget-mb");
  return request;
}

int run(const RecommendOptions& options) {
  const RecommendRequest request = requestOf(options);
  const Results results = readResults(options.run);
  const Recommendation answer = recommend(results, request);
  fmt::print("{}", print(answer, request, results, {options.run, describe(Technique())}));
  if (answer.chosen) return 0;
  // Without an answer, better references or more repetitions may give one, or nothing will.
  return static_cast<int>(answer.undecided.empty() ? Failure::verdict : Failure::inconclusive);
}

}  // namespace

void addRecommendCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("recommend", "the cheapest technique of a run that is good enough");
  const auto options = std::make_shared<RecommendOptions>();
  RecommendRequest& request = options->request;
  command->add_option("RUN_DIR", options->run, "folder of a run")->required();
  command->add_option("--max-error", options->maxError, "METRIC=X: the cheapest technique with at most this error");
  command->add_option("--budget-ms", request.budgetMs, "the best technique with frames of at most this time")
      ->check(positiveNumber());
  command->add_option("--budget-ratio", request.budgetRatio, "likewise, as a multiple of a plain frame")
      ->check(positiveNumber());
  command->add_option("--budget-mb", request.budgetMb, "likewise, memory of the probes in 10^6 bytes")
      ->check(positiveNumber());
  command->add_option("--metric", options->metric, "what --budget-.. minimise (default flip_hdr)");
  command->add_option("--scene", request.selection.scenes, "only scenes whose name matches this regular expression");
  command->add_option("--object", request.selection.object, "error of this object or material alone");
  command
      ->add_option("--region", options->region, "whole or mask (default: the mask where a scene has mirrors or glass)")
      ->check(CLI::IsMember({"whole", "mask"}));
  command->add_flag("--worst-frame", request.selection.worstFrame, "in place of the mean over the frames");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace pb
