#include "bench/interrupt.h"

#include <csignal>

#include "scenes/error.h"

namespace pb {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may write only lock-free atomics");

extern "C" void requestInterrupt(int signal) {
  requested = true;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void installInterruptHandler() {
  std::signal(SIGINT, requestInterrupt);
  std::signal(SIGTERM, requestInterrupt);
}

const std::atomic<bool>& interruptRequested() { return requested; }

void throwIfInterrupted() {
  if (requested) throw Error(Failure::interrupted, "interrupted");
}

}  // namespace pb
