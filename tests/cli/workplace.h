// A folder in which the program runs a suite.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files.h"
#include "tests/cli/program.h"

namespace pb {

// With a suite file and a reference store of its own.
class Workplace {
 public:
  explicit Workplace(const std::string& suite) { writeFileAtomically(suitePath(), suite); }

  std::string path(const std::string& name) const { return folder_.file(name); }
  std::string suitePath() const { return path("suite.toml"); }
  std::vector<std::string> command(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"run", suitePath(), "--out", path(out)};
    if (std::ranges::find(more, "--store") == more.end()) arguments.insert(arguments.end(), {"--store", path("store")});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  ProgramResult run(const std::string& out, const std::vector<std::string>& more = {}) const {
    return runProgram(command(out, more));
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace pb
