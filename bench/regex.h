// Regular expressions of the command line.
#pragma once

#include <regex>
#include <string>
#include <string_view>

#include "scenes/error.h"

namespace pb {

// Throws an input Error that names the option whose value it is.
inline std::regex compileRegex(const std::string& expression, std::string_view option) {
  try {
    return std::regex(expression);
  } catch (const std::regex_error&) {
    throwInputError("{} wants a regular expression, got '{}'", option, expression);
  }
}

}  // namespace pb
