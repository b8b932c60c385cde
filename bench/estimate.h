// A number with what is known of its uncertainty.
#pragma once

#include <algorithm>

namespace pb {

// value lies in [low, high], a 95 % interval; low = value = high where none is known.
struct Estimate {
  double value = 0, low = 0, high = 0;

  double plusMinus() const { return std::max(high - value, value - low); }
  bool hasInterval() const { return low < high; }
  // Whether the whole interval lies below 0, or above: the sign is known.
  bool isNegative() const { return high < 0; }
  bool isPositive() const { return low > 0; }
  Estimate operator-() const { return {-value, -high, -low}; }
};

// a - b where nothing is known of what the two have in common: all that their intervals leave open. Its sign is known
// exactly where they don't overlap.
inline Estimate unpairedDifference(const Estimate& a, const Estimate& b) {
  return {a.value - b.value, a.low - b.high, a.high - b.low};
}

}  // namespace pb
