#include "bench/certify.h"

#include <fmt/format.h>

#include <cstdio>

#include "bench/commands/commands.h"
#include "scenes/error.h"

namespace pb {
namespace {

int certify(const GlobalOptions& globals) {
  RasterDevice device(globals.backend());
  std::vector<Check> checks;
  for (const Certificate& certificate : certificates()) {
    fmt::print(stderr, "{}: {}\n", certificate.name, certificate.description);
    const std::vector<Check> more = certificate.run(device);
    checks.insert(checks.end(), more.begin(), more.end());
  }
  fmt::print("{}", toMarkdown(checks));
  if (!allPassed(checks)) throw Error(Failure::verdict, summary(checks));
  return 0;
}

}  // namespace

void addCertifyCommand(CLI::App& app, const GlobalOptions& globals, Action& action) {
  app.add_subcommand("certify", "check both renderers against closed forms and each other")->callback([&] {
    action = [&globals] { return certify(globals); };
  });
}

}  // namespace pb
