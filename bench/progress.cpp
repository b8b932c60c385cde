#include "bench/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pb {
namespace {

constexpr std::size_t kBarWidth = 30;
constexpr const char* kClearLine = "\r\x1b[K";

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double secondsLeft(std::size_t done, std::size_t total, double elapsed) {
  return elapsed / static_cast<double>(done) * static_cast<double>(total - done);
}

}  // namespace

std::string printDuration(double seconds) {
  const long long whole = std::llround(std::max(0.0, seconds));
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string printBar(const std::string& phase, std::size_t done, std::size_t total, double elapsedSeconds) {
  const std::size_t filled = total == 0 ? kBarWidth : kBarWidth * done / total;
  const std::size_t percent = total == 0 ? 100 : 100 * done / total;
  std::string text = fmt::format("[{}{}] {:3} %  {} {}/{}", std::string(filled, '#'),
                                 std::string(kBarWidth - filled, '-'), percent, phase, done, total);
  if (done > 0 && done < total)
    text += fmt::format(", {} left", printDuration(secondsLeft(done, total, elapsedSeconds)));
  return text;
}

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::begin(const std::string& phase, std::size_t total) {
  const std::lock_guard lock(mutex_);
  phase_ = phase;
  done_ = printedTenth_ = 0;
  total_ = total;
  start_ = std::chrono::steady_clock::now();
  if (terminal_) print();
}

void Progress::step() {
  const std::lock_guard lock(mutex_);
  ++done_;
  // Without a terminal a line for every tenth is enough: logs are read afterwards.
  const std::size_t tenth = 10 * done_ / std::max<std::size_t>(total_, 1);
  if (terminal_ || (tenth > printedTenth_ && done_ < total_)) print();
  printedTenth_ = tenth;
}

void Progress::end() {
  const std::lock_guard lock(mutex_);
  phases_.push_back({phase_, done_, secondsSince(start_)});
  fmt::print(stderr, "{}{}: {} of {} in {}\n", terminal_ ? kClearLine : "", phase_, done_, total_,
             printDuration(phases_.back().seconds));
  phase_.clear();
}

void Progress::message(const std::string& text) {
  const std::lock_guard lock(mutex_);
  fmt::print(stderr, "{}{}\n", terminal_ ? kClearLine : "", text);
  if (terminal_ && !phase_.empty()) print();
}

void Progress::print() {
  if (terminal_) {
    fmt::print(stderr, "{}{}", kClearLine, printBar(phase_, done_, total_, secondsSince(start_)));
    std::fflush(stderr);
  } else {
    fmt::print(stderr, "{}: {} of {}, {} left\n", phase_, done_, total_,
               printDuration(secondsLeft(done_, total_, secondsSince(start_))));
  }
}

}  // namespace pb
