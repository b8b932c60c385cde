// Progress of long work on standard error: one bar with the time left on a terminal, plain lines otherwise.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace pb {

// "0:07", "12:30", "1:02:03".
std::string printDuration(double seconds);

// "[#####-----] 50 %  references 8/16, 0:07 left"; time left is guessed from the mean time per step so far.
std::string printBar(const std::string& phase, std::size_t done, std::size_t total, double elapsedSeconds);

// A phase that has ended.
struct Phase {
  std::string name;
  std::size_t steps = 0;  // that were done
  double seconds = 0;
};

// One phase of the work at a time. All members may be called from any thread.
class Progress {
 public:
  Progress();

  void begin(const std::string& phase, std::size_t total);
  void step();  // one more of the total is done
  void end();   // of the phase; how long it took is printed

  // Phases that have ended, in order. Not while one is running.
  const std::vector<Phase>& phases() const { return phases_; }

  // A line of its own that does not damage the bar.
  void message(const std::string& text);

 private:
  void print();

  std::mutex mutex_;
  const bool terminal_;
  std::string phase_;
  std::size_t done_ = 0, total_ = 0, printedTenth_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::vector<Phase> phases_;
};

}  // namespace pb
