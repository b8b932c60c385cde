// The commands of the program: each adds its options to the command line and says what runs when it is chosen.
//
// Adding one: a file in bench/commands/ and a line in the table of commands.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "raster/renderer.h"
#include "raster/technique.h"

namespace pb {

// Options that stand before or after any command.
struct GlobalOptions {
  int threads = 0;  // 0: all cores
  std::string gl;   // "osmesa" or "egl"

  GlBackend backend() const;
  int threadCount() const;
};

// What main() runs after parsing; returns the exit code, throws Errors.
using Action = std::function<int()>;

// --threads, --gl and --version.
void addGlobalOptions(CLI::App& app, GlobalOptions& globals);

// Adds all commands to the app. The chosen one puts itself into `action`; `globals` and `action` must outlive it.
void addCommands(CLI::App& app, const GlobalOptions& globals, Action& action);

void addAxesCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addBlessCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addCertifyCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addCheckCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addCompareCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addInitCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addMergeCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addRecommendCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addRenderCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addReportCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addRunCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addScenesCommand(CLI::App& app, const GlobalOptions& globals, Action& action);
void addSelftestGateCommand(CLI::App& app, const GlobalOptions& globals, Action& action);

// For options: a finite number above 0.
CLI::Validator positiveNumber();

// One line a row, names padded to one width.
std::string printList(const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace pb
