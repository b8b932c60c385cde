// Elementary functions of positive floats, free of branches and calls so that loops over rows vectorise. Their error
// bounds are tested; correct rounding is not promised, equal bits for every instruction set are.
#pragma once

#include <bit>
#include <cstdint>

namespace pb {

// Base-2 logarithm of a positive normal number; absolute error below 3e-7 * max(1, |log2 x|).
inline float fastLog2(float x) {
  constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3;  // puts the mantissa m into [sqrt(1/2), sqrt(2))
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kSqrtHalfBits) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  // log2 m = 2 / ln 2 * atanh(s); the first term left out is below s^10 / 11 = 2e-9 of the result.
  const float s = (m - 1.0f) / (m + 1.0f);
  const float s2 = s * s;
  constexpr float k = 2.885390082f;  // 2 / ln 2
  const float series = k + s2 * (k / 3.0f + s2 * (k / 5.0f + s2 * (k / 7.0f + s2 * (k / 9.0f))));
  return static_cast<float>(exponent) + s * series;
}

// 2^x for x in [-126, 127]; relative error below 2e-7.
inline float fastExp2(float x) {
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: adding and subtracting it rounds to the nearest integer
  const float whole = (x + kRound) - kRound;
  // Taylor series of exp(u), |u| <= ln(2) / 2; the first term left out is below u^8 / 8! = 6e-9.
  const float u = (x - whole) * 0.693147181f;
  const float series =
      1.0f +
      u * (1.0f +
           u * (1.0f / 2 + u * (1.0f / 6 + u * (1.0f / 24 + u * (1.0f / 120 + u * (1.0f / 720 + u * (1.0f / 5040)))))));
  return series * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

// x^p for x > 0 with x^p a normal number.
inline float fastPow(float x, float p) { return fastExp2(p * fastLog2(x)); }

// Cube root of a positive normal number; relative error below 1e-7.
inline float fastCbrt(float x) {
  // The bits of a float are nearly its logarithm, so -1/3 of them give a first z = x^(-1/3). The constant makes the
  // largest |e| below smallest, 0.103.
  const float third = static_cast<float>(std::bit_cast<std::int32_t>(x)) * (1.0f / 3.0f);
  float z = std::bit_cast<float>(0x54a1f000 - static_cast<std::int32_t>(third));
  // With e = 1 - x z^3, x^(-1/3) = z (1 - e)^(-1/3) = z (1 + e/3 + 2/9 e^2 + 14/81 e^3 + ...): good to 2e-5.
  const float e = 1.0f - x * z * z * z;
  z += z * e * (1.0f / 3.0f + e * (2.0f / 9.0f + e * (14.0f / 81.0f)));
  // One step of Newton's method for the root y itself, y - (y^3 - x) / (3 y^2), squares that error.
  const float y = x * z * z;
  return y + (x - y * y * y) * (z * z * (1.0f / 3.0f));
}

}  // namespace pb
