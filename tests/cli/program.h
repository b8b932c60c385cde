// Runs the probebench program as a user does and keeps what it says.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "scenes/files.h"

namespace pb {

struct ProgramResult {
  int exitCode = -1;  // -1: ended by a signal
  std::string out, err;
};

struct ProgramOptions {
  long maxFileBytes = 0;       // no file may grow beyond this: a full disk that root can't write to either; 0: no limit
  std::string standardOutput;  // a file in place of the captured one
  std::string program = PROBEBENCH_PROGRAM;
};

ProgramResult runProgram(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

// A program that is still running, for interrupts.
class RunningProgram {
 public:
  explicit RunningProgram(const std::vector<std::string>& arguments, const ProgramOptions& options = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void signal(int number) const;
  ProgramResult wait();

 private:
  std::string captured(const char* name) const;

  TemporaryFolder folder_;
  pid_t pid_ = -1;
};

}  // namespace pb
