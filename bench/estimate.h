// A number with what is known of its uncertainty.
#pragma once

#include <algorithm>
#include <limits>

namespace pb {

// value lies in [low, high], a 95 % interval; low = value = high where it is exact. Where there is noise and nobody has
// measured what it does to the number, the interval leaves everything open: see unknown().
struct Estimate {
  double value = 0, low = 0, high = 0;

  static Estimate exact(double value) { return {value, value, value}; }
  static Estimate unknown(double value) {
    return {value, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }

  // The larger of the two sides: intervals that allow for a bias (bench/jackknife.h) are wider on its side.
  double plusMinus() const { return std::max(high - value, value - low); }
  // Whether it is exact or has an interval that says something.
  bool isKnown() const {
    return low != -std::numeric_limits<double>::infinity() || high != std::numeric_limits<double>::infinity();
  }
  bool isExact() const { return isKnown() && !(low < high); }
  // Whether the whole interval lies below 0, or above: the sign is known.
  bool isNegative() const { return high < 0; }
  bool isPositive() const { return low > 0; }
  Estimate operator-() const { return {-value, -high, -low}; }
};

// a - b where nothing is known of what the two have in common: all that their intervals leave open. Its sign is known
// exactly where they don't overlap; it is unknown if one of them is.
inline Estimate unpairedDifference(const Estimate& a, const Estimate& b) {
  return {a.value - b.value, a.low - b.high, a.high - b.low};
}

}  // namespace pb
