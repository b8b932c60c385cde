// What a refused input says.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "scenes/error.h"

namespace pb {

// The sentence of the input Error that `action` throws; a failure of the test for an Error of another kind.
std::string messageOf(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Failure::input);
    return error.what();
  }
  return "no error";
}

}  // namespace pb
