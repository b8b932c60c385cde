// Places of messages.
#pragma once

#include <string>

#include "scenes/error.h"

namespace pb {

// Runs an action, putting the place before the message of an Error.
template <class Action>
auto atPlace(const std::string& place, const Action& action) {
  try {
    return action();
  } catch (const Error& e) {
    throw Error(e.kind(), place + ": " + e.what());
  }
}

}  // namespace pb
