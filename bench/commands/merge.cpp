#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <system_error>
#include <vector>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "bench/recommend.h"
#include "bench/report/page.h"
#include "bench/run_directory.h"
#include "scenes/error.h"

namespace pb {
namespace {

struct MergeOptions {
  std::vector<std::string> runs;
  std::string output;
};

void requireOwnFolder(const MergeOptions& options) {
  namespace fs = std::filesystem;
  // With a file name behind it, "a" and "a/" are the same.
  const auto canonical = [](const std::string& folder) { return fs::weakly_canonical(fs::path(folder) / "run.json"); };
  for (const std::string& run : options.runs)
    if (canonical(run) == canonical(options.output))
      throwInputError("the joined run may not replace one of its parts, got '{}' as both", options.output);
  if (fs::exists(fs::path(options.output) / "run.json"))
    throwInputError("'{}' already holds a run, choose another -o", options.output);
}

void requirePassedControl(const Provenance& part, const std::string& run) {
  if (part.controlOutcome != kControlPassed)
    throwInputError("a run whose control did not pass can't be merged, that of '{}': {}", run, part.controlOutcome);
}

bool hasCosts(const Results& results) {
  return std::ranges::any_of(results.cells, [](const CellResult& cell) { return cell.cost.has_value(); });
}

// Numbers of different suites, scenes, programs or drivers don't belong into one table.
void requireSameCircumstances(const Provenance& a, const Provenance& b, const std::string& run) {
  if (a.suiteHash != b.suiteHash) throwInputError("merged runs must be of the same suite, '{}' is of another", run);
  if (a.toolVersion != b.toolVersion || a.gitHash != b.gitHash)
    throwInputError("merged runs must be of the same program, '{}' is of {} {}", run, b.toolVersion, b.gitHash);
  if (a.glRenderer != b.glRenderer || a.glVersion != b.glVersion)
    throwInputError("merged runs must be of the same GL driver, '{}' is of {} {}", run, b.glRenderer, b.glVersion);
  for (const auto& [scene, hash] : b.sceneHashes)
    if (const auto other = a.sceneHashes.find(scene); other != a.sceneHashes.end() && other->second != hash)
      throwInputError("merged runs must be of the same scenes, '{}' has another '{}'", run, scene);
}

void requireSameMachine(const Provenance& a, const Provenance& b, const std::string& run) {
  if (a.cpu != b.cpu || a.threads != b.threads)
    throwInputError("merged costs must be of the same CPU and number of threads, '{}' is of {} with {}", run, b.cpu,
                    b.threads);
}

// Shards of one suite call their pictures alike where they show the same.
void copyPictures(const std::string& run, const RunDirectory& directory) {
  namespace fs = std::filesystem;
  const fs::path pictures = fs::path(run) / directory.imagesFolder().filename();
  if (!fs::exists(pictures)) return;
  std::error_code failure;
  fs::copy(pictures, directory.imagesFolder(), fs::copy_options::recursive | fs::copy_options::skip_existing, failure);
  if (failure)
    throwEnvironmentError("the pictures of '{}' can't be copied to '{}': {}", run, directory.imagesFolder().string(),
                          failure.message());
}

int merge(const MergeOptions& options) {
  requireOwnFolder(options);
  Results merged = readResults(options.runs.front());
  requirePassedControl(merged.provenance, options.runs.front());
  std::set<std::string> keys;
  for (const CellResult& cell : merged.cells) keys.insert(cell.key());
  for (auto run = options.runs.begin() + 1; run != options.runs.end(); ++run) {
    const Results part = readResults(*run);
    requirePassedControl(part.provenance, *run);
    requireSameCircumstances(merged.provenance, part.provenance, *run);
    if (hasCosts(merged) || hasCosts(part)) requireSameMachine(merged.provenance, part.provenance, *run);
    for (const CellResult& cell : part.cells) {
      if (!keys.insert(cell.key()).second)
        throwInputError("cell '{}' of '{}' stands in another run too", shortKey(cell.key(), describe(Technique())),
                        *run);
      merged.cells.push_back(cell);
    }
    merged.attribution.insert(merged.attribution.end(), part.attribution.begin(), part.attribution.end());
    merged.provenance.sceneHashes.insert(part.provenance.sceneHashes.begin(), part.provenance.sceneHashes.end());
  }
  RunDirectory directory(options.output, {merged.provenance.suiteName, "merged"}, false);
  for (const std::string& run : options.runs) copyPictures(run, directory);
  directory.finish(merged, "");
  const std::string folder = directory.folder().string();
  writePage({{"", folder, merged}}, summaryLines(merged, {folder, describe(Technique())}), pageOfRun(folder));
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
