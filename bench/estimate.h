// A number with what is known of its uncertainty.
#pragma once

#include <algorithm>

namespace pb {

// value lies in [low, high], a 95 % interval; low = value = high where none is known.
struct Estimate {
  double value = 0, low = 0, high = 0;

  double plusMinus() const { return std::max(high - value, value - low); }
  bool hasInterval() const { return low < high; }
  // Whether the whole interval lies below that of the other.
  bool isBelow(const Estimate& other) const { return high < other.low; }
  Estimate operator-() const { return {-value, -high, -low}; }
};

}  // namespace pb
