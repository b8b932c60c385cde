// Other programs, run without a shell: what an external technique's command is started with.
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

namespace pb {

struct ChildResult {
  enum class End { exited, killedBySignal, timedOut, stopped };
  End end = End::exited;
  int code = 0;           // exit code, or the number of the signal
  std::string lastWords;  // the end of what it wrote to standard error, at most kMaxLastWords bytes
};

inline constexpr std::size_t kMaxLastWords = 4096;

// The file that a name without a slash means on the PATH; a name with one is that file. Throws an environment Error
// that says `who` wants it if there is no such executable file.
std::string findProgram(const std::string& name, const std::string& who);

// Runs the program until it ends, for at most `timeout` and until `stop` is set; then it and all that it started (its
// process group) are killed: asked by SIGTERM, after two seconds forced. What it leaves running when it ends is killed
// too. It works in `folder`, reads nothing, and its standard output is thrown away. Throws an environment Error if it
// can't be started.
ChildResult runChild(const std::vector<std::string>& command, const std::string& folder, std::chrono::seconds timeout,
                     const std::atomic<bool>& stop);

}  // namespace pb
