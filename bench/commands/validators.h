// What values of options may be, beyond what CLI11 itself checks: its ranges let NaN pass, its unsigned numbers wrap.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <optional>
#include <string>

#include "scenes/spec.h"

namespace pb {

// A finite number from `lower` to `upper`.
inline CLI::Validator numberFrom(double lower, double upper) {
  const auto check = [lower, upper](const std::string& text) {
    const std::optional<double> number = parseNumber(text);
    return number && *number >= lower && *number <= upper
               ? std::string()
               : fmt::format("wants a number from {:g} to {:g}, got '{}'", lower, upper, text);
  };
  return {check, fmt::format("{:g} to {:g}", lower, upper), "number in a range"};
}

inline CLI::Validator wholeNumber() {
  const auto check = [](const std::string& text) {
    const std::optional<long long> number = parseInteger(text);
    return number && *number >= 0
               ? std::string()
               : fmt::format("wants an integer from 0 to {}, got '{}'", std::numeric_limits<long long>::max(), text);
  };
  return {check, "", "whole number"};
}

// An empty variable of a shell would otherwise mean the default folder.
inline CLI::Validator folderName() {
  const auto check = [](const std::string& text) { return text.empty() ? "wants a folder, got ''" : std::string(); };
  return {check, "", "folder"};
}

}  // namespace pb
