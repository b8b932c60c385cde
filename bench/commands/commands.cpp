#include "bench/commands/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "bench/version.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

std::string driverText(const GlobalOptions& globals) {
  try {
    const GlInfo gl = RasterDevice(globals.backend()).info();
    return fmt::format("{}, {}, {}", gl.backend, gl.renderer, gl.version);
  } catch (const Error& error) {
    return error.what();
  }
}

std::string versionText(const GlobalOptions& globals) {
  std::vector<std::pair<std::string, std::string>> rows = {
      {"probebench", fmt::format("{} ({})", toolVersion(), gitHash())}, {"OpenGL", driverText(globals)}};
  for (const auto& [name, version] : libraryVersions()) rows.emplace_back(name, version);
  return printList(rows);
}

}  // namespace

GlBackend GlobalOptions::backend() const { return gl == "egl" ? GlBackend::egl : GlBackend::osmesa; }

int GlobalOptions::threadCount() const {
  return threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void addGlobalOptions(CLI::App& app, GlobalOptions& globals) {
#ifdef PROBEBENCH_OSMESA
  globals.gl = "osmesa";
#else
  globals.gl = "egl";
#endif
  app.require_subcommand(0, 1);  // none is main()'s to refuse: here a misspelt command would be reported as absent
  app.fallthrough();             // global options may stand after the command
  app.add_option("--threads", globals.threads, "processor cores to use; 0: all")->check(CLI::Range(0, 1024));
  app.add_option("--gl", globals.gl, "where OpenGL comes from: osmesa or egl")
      ->check(CLI::IsMember({"osmesa", "egl"}))
      ->capture_default_str();
  app.add_flag_callback(
      "--version", [&globals] { throw CLI::CallForVersion(versionText(globals), 0); },
      "print versions of the program, its libraries and the GL driver");
}

void addCommands(CLI::App& app, const GlobalOptions& globals, Action& action) {
  constexpr void (*kCommands[])(CLI::App&, const GlobalOptions&, Action&) = {
      addRunCommand,       addRenderCommand, addCompareCommand,     addReportCommand, addCheckCommand,
      addBlessCommand,     addMergeCommand,  addAxesCommand,        addScenesCommand, addCertifyCommand,
      addRecommendCommand, addInitCommand,   addSelftestGateCommand};
  for (const auto& add : kCommands) add(app, globals, action);
}

CLI::Validator positiveNumber() {
  const auto check = [](const std::string& text) {
    const std::optional<double> number = parseNumber(text);
    return number && *number > 0 ? std::string() : fmt::format("wants a number above 0, got '{}'", text);
  };
  return {check, "", "positive number"};
}

std::string printList(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::size_t width = 0;
  for (const auto& [name, text] : rows) width = std::max(width, name.size());
  std::string list;
  for (const auto& [name, text] : rows) list += fmt::format("{:{}}  {}\n", name, width, text);
  return list;
}

}  // namespace pb
