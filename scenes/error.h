// The one exception type for everything that is not our own mistake: bad input, GL, Embree and I/O failures.
// Thrown anywhere, caught once in main(), which prints the message and exits with the failure's code.
// A message is one sentence: the rule, the offending value, the place.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace pb {

// The value is the process exit code.
enum class Failure {
  verdict = 1,       // a regression or a failed control
  input = 2,         // bad usage, suite, scene or other input
  environment = 3,   // no GL, no Embree, disk full, output not writable
  inconclusive = 4,  // noise floor or interval too wide, driver drift
  interrupted = 130  // Ctrl-C
};

class Error : public std::runtime_error {
 public:
  Error(Failure kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Failure kind() const { return kind_; }

 private:
  Failure kind_;
};

template <class... Args>
[[noreturn]] void throwInputError(fmt::format_string<Args...> message, Args&&... args) {
  throw Error(Failure::input, fmt::format(message, std::forward<Args>(args)...));
}

template <class... Args>
[[noreturn]] void throwEnvironmentError(fmt::format_string<Args...> message, Args&&... args) {
  throw Error(Failure::environment, fmt::format(message, std::forward<Args>(args)...));
}

}  // namespace pb
