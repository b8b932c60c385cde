#include "bench/selftest_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "bench/certify.h"
#include "bench/commands/commands.h"
#include "bench/platform.h"
#include "bench/provenance.h"
#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr double kPlantedEnergy = 0.01;

struct SelftestOptions {
  std::string suite = "gate", baseline, store;
  std::vector<std::string> faults;  // all if it is empty
  int repeats = 1;
  bool noFaults = false;
};

// Of the source tree, or of the installation beside the program.
std::string shippedBaseline(const std::string& suite) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path installed = program.parent_path().parent_path() / "share" / "probebench" / "baselines";
  const fs::path folder = fs::is_directory(installed) ? installed : fs::path(PROBEBENCH_BASELINES_DIR);
  return (folder / (suite + ".json")).string();
}

// On another platform the gate drifts and catches nothing.
void requireSamePlatform(const Baseline& baseline, const Provenance& now, const std::string& path) {
  const std::vector<PlatformDifference> differences = platformDifferences(baseline.provenance, now);
  if (!differences.empty())
    throw Error(Failure::inconclusive,
                fmt::format("baseline '{}' is of another platform: {}; bless a run of the suite here and give it to "
                            "--baseline",
                            path, describe(differences)));
}

std::vector<std::string> faultNames() {
  std::vector<std::string> names;
  for (const NamedFault& fault : plantedFaults()) names.push_back(fault.name);
  return names;
}

// With all faults, the smallest one that is caught is searched for, too.
bool catchFaults(const GateSelftest& selftest, const std::vector<std::string>& wanted) {
  std::vector<FaultOutcome> outcomes;
  for (const NamedFault& fault : plantedFaults()) {
    if (!wanted.empty() && std::ranges::find(wanted, fault.name) == wanted.end()) continue;
    fmt::print(stderr, "planted: {}\n", fault.name);
    outcomes.push_back(selftest.plant(fault));
  }
  const bool all = std::ranges::all_of(outcomes, &FaultOutcome::isCaught);
  const double smallest = all && wanted.empty() ? selftest.smallestCaughtEnergy(kPlantedEnergy) : 0.0;
  fmt::print("{}\n", printFaults(outcomes, smallest));
  return all;
}

int runSelftest(const SelftestOptions& options, const GlobalOptions& globals) {
  Suite suite = loadSuite(options.suite);
  const Scenes scenes = loadScenes(suite);
  const std::string baselinePath = options.baseline.empty() ? shippedBaseline(suite.name) : options.baseline;
  const Baseline baseline = readBaseline(baselinePath);
  RasterDevice device(globals.backend());
  Provenance provenance = makeProvenance(suite, scenes, device.info(), globals.threadCount());
  requireSamePlatform(baseline, provenance, baselinePath);
  provenance.controlOutcome = summary(runControl(device));
  const ReferenceStore store(options.store.empty() ? defaultStoreFolder() : fs::path(options.store));
  const TemporaryFolder scratch;
  Progress progress;
  const SelftestContext context{suite, scenes, device, store, baseline, provenance, scratch.path(), progress};
  const GateSelftest selftest(context);
  const RepeatOutcome repeats =
      selftest.repeat(options.repeats, [&](int run) { fmt::print(stderr, "unchanged run {} done\n", run); });
  fmt::print("{}\n", printRepeats(repeats));
  std::fflush(stdout);
  const bool caught = options.noFaults || catchFaults(selftest, options.faults);
  return caught && repeats.isQuiet() ? 0 : static_cast<int>(Failure::verdict);
}

}  // namespace

void addSelftestGateCommand(CLI::App& app, const GlobalOptions& globals, Action& action) {
  CLI::App* command = app.add_subcommand("selftest-gate", "plant faults and see whether the gate catches them");
  const auto options = std::make_shared<SelftestOptions>();
  command->add_option("--suite", options->suite, "a .toml file or the name of a shipped suite")->capture_default_str();
  command->add_option("--baseline", options->baseline, "baseline file (default: the shipped one of the suite)");
  command->add_option("--store", options->store, "folder of stored references");
  command->add_option("--repeats", options->repeats, "unchanged runs, which must raise no alarm")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command->add_option("--fault", options->faults, "plant this fault alone; may be given again")
      ->check(CLI::IsMember(faultNames()))
      ->allow_extra_args(false);
  command->add_flag("--no-faults", options->noFaults, "the unchanged runs only")->excludes("--fault");
  command->callback(
      [&action, &globals, options] { action = [&globals, options] { return runSelftest(*options, globals); }; });
}

}  // namespace pb
