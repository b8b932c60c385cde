#include "bench/external_sequence.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/axes.h"
#include "bench/external.h"
#include "bench/picture_names.h"

namespace pb {

std::string nameOfExternal(const RunContext& context, const PlannedSequence& sequence) {
  return fmt::format("external {} on {}", context.suite.externals[*sequence.external].name,
                     context.suite.scenes[sequence.scene].name);
}

std::optional<Skipped> renderExternal(const RunContext& context, const PlannedSequence& sequence,
                                      const std::vector<int>& frames, const std::function<void(ShownFrame)>& take) {
  const Suite& suite = context.suite;
  const SuiteScene& scene = suite.scenes[sequence.scene];
  const ExternalTechnique& technique = suite.externals[*sequence.external];
  ExternalRequest request{technique,   PictureNames(suite, context.scenes).external(sequence.scene),
                          suite.image, describe(suite.technique),
                          {},          suite.cost.repetitions};
  for (int frame = scene.startFrame(); frame <= frames.back(); ++frame)
    request.frames.push_back(
        {frame, std::ranges::binary_search(frames, frame), makeSnapshot(context, sequence.scene, frame)});
  const ExternalOutcome outcome =
      runExternal(request, [&](int frame, Image picture, const std::optional<ReportedCost>& cost) {
        ShownFrame shown{std::move(picture), makeCell(suite, sequence, frame)};
        shown.cell.reportedCost = cost;
        take(std::move(shown));
      });
  const std::string what = nameOfExternal(context, sequence);
  if (!outcome.messages.empty()) context.progress.message(fmt::format("{}: {}", what, outcome.messages));
  if (!outcome.skipped) return std::nullopt;
  context.progress.message(fmt::format("skipped: {}: {}", what, *outcome.skipped));
  return Skipped(what, *outcome.skipped);
}

}  // namespace pb
