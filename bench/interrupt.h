// Ctrl-C as a request: long work looks at the flag and stops where nothing is lost.
#pragma once

#include <atomic>

namespace pb {

// From now on the first SIGINT or SIGTERM sets the flag; the second ends the process at once.
void installInterruptHandler();

const std::atomic<bool>& interruptRequested();

// Throws Error(Failure::interrupted) if it was requested.
void throwIfInterrupted();

}  // namespace pb
