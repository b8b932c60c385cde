#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "bench/commands/commands.h"
#include "bench/interrupt.h"
#include "bench/version.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace {

int fail(const std::string& sentence, pb::Failure kind) {
  fmt::print(stderr, "probebench: {}\n", sentence);
  return static_cast<int>(kind);
}

// Runs the command; everything that can go wrong ends here.
int perform(const pb::Action& action) {
  try {
    const int exitCode = action();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      pb::throwEnvironmentError("standard output can't be written");
    return exitCode;
  } catch (const pb::Error& error) {
    return fail(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    return fail("memory is exhausted", pb::Failure::environment);
  } catch (const std::exception& error) {
    return fail(error.what(), pb::Failure::environment);
  }
}

// Words of the command line that nothing takes, in their order.
std::string sentenceOf(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining(true);
  if (!app.get_subcommands().empty() || words.empty() || words.front().starts_with('-'))
    return fmt::format("not expected on the command line: {}", fmt::join(words, " "));
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  return "command " + pb::unknownMessage(words.front(), commands);
}

// Where the options of the command in question stand.
std::string helpHint(const CLI::App& app) {
  std::string command = "probebench";
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().front();
    command += " " + at->get_name();
  }
  return fmt::format("; see {} --help", command);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How wrong are dynamic cube maps, and what do they cost?", "probebench");
  pb::GlobalOptions globals;
  pb::Action action;
  pb::addGlobalOptions(app, globals);
  pb::addCommands(app, globals, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return perform([&] { return app.exit(request); });
  } catch (const CLI::ExtrasError&) {
    return fail(sentenceOf(app) + helpHint(app), pb::Failure::input);
  } catch (const CLI::ParseError& error) {
    return fail(error.what() + helpHint(app), pb::Failure::input);
  }
  if (!action) return fail("a command is wanted; see probebench --help", pb::Failure::input);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(globals.threadCount()));
  pb::installInterruptHandler();
  return perform(action);
}
