#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <set>
#include <vector>

#include "bench/commands/commands.h"
#include "bench/run_directory.h"
#include "scenes/error.h"

namespace pb {
namespace {

struct MergeOptions {
  std::vector<std::string> runs;
  std::string output;
};

// Numbers of different suites, programs or drivers don't belong into one table.
void requireSameCircumstances(const Provenance& a, const Provenance& b, const std::string& run) {
  if (a.suiteHash != b.suiteHash) throwInputError("merged runs must be of the same suite, '{}' is of another", run);
  if (a.toolVersion != b.toolVersion || a.gitHash != b.gitHash)
    throwInputError("merged runs must be of the same program, '{}' is of {} {}", run, b.toolVersion, b.gitHash);
  if (a.glRenderer != b.glRenderer || a.glVersion != b.glVersion)
    throwInputError("merged runs must be of the same GL driver, '{}' is of {} {}", run, b.glRenderer, b.glVersion);
}

int merge(const MergeOptions& options) {
  Results merged = readResults(options.runs.front());
  std::set<std::string> keys;
  for (const CellResult& cell : merged.cells) keys.insert(cell.key());
  for (auto run = options.runs.begin() + 1; run != options.runs.end(); ++run) {
    const Results part = readResults(*run);
    requireSameCircumstances(merged.provenance, part.provenance, *run);
    for (const CellResult& cell : part.cells) {
      if (!keys.insert(cell.key()).second)
        throwInputError("cell '{}' of '{}' stands in another run too", cell.key(), *run);
      merged.cells.push_back(cell);
    }
    merged.provenance.sceneHashes.insert(part.provenance.sceneHashes.begin(), part.provenance.sceneHashes.end());
  }
  RunDirectory directory(options.output, {merged.provenance.suiteName, "merged"}, false);
  directory.finish(merged, "");
  fmt::print(stderr, "merged {} cells of {} runs into {}\n", merged.cells.size(), options.runs.size(), options.output);
  return 0;
}

}  // namespace

void addMergeCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* command = app.add_subcommand("merge", "join the runs of a suite's shards, given in order");
  const auto options = std::make_shared<MergeOptions>();
  command->add_option("RUN_DIR", options->runs, "folders of runs")->required();
  command->add_option("-o", options->output, "folder of the joined run")->required();
  command->callback([&action, options] { action = [options] { return merge(*options); }; });
}

}  // namespace pb
