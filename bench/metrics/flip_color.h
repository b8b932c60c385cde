// The colour spaces of FLIP (Andersson et al. 2020), written so that loops over rows vectorise.
//
// Tristimulus values are divided by those of white, so XYZ of (1,1,1) is (1,1,1). The linear opponent space is FLIP's
// YCxCz without offset and factors, Yy = 116 y - 16, Cx = 500 cx, Cz = 200 cz, which filters that keep constants allow:
//   y = Y,  cx = X - Y,  cz = Y - Z.
#pragma once

#include <cmath>

#include "bench/metrics/fast_math.h"

namespace pb::flip {

struct Matrix3 {
  double m[3][3];
};

constexpr Matrix3 inverse(const Matrix3& a) {
  Matrix3 cofactors{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactors.m[i][j] = a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1];
    }
  }
  const double determinant =
      a.m[0][0] * cofactors.m[0][0] + a.m[0][1] * cofactors.m[0][1] + a.m[0][2] * cofactors.m[0][2];
  Matrix3 result{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.m[i][j] = cofactors.m[j][i] / determinant;
  }
  return result;
}

// Rec. 709 primaries and D65 white. The integers are the numerators of the exact matrix; dividing each row by its sum,
// the white point, needs no denominators.
constexpr Matrix3 xyzFromLinearRgb() {
  constexpr double n[3][3] = {{10135552, 8788810, 4435075}, {2613072, 8788810, 887015}, {1425312, 8788810, 70074185}};
  Matrix3 result{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.m[i][j] = n[i][j] / (n[i][0] + n[i][1] + n[i][2]);
  }
  return result;
}

inline constexpr Matrix3 kXyzFromLinearRgb = xyzFromLinearRgb();
inline constexpr Matrix3 kLinearRgbFromXyz = inverse(kXyzFromLinearRgb);

struct Triple {
  float v0, v1, v2;
};

template <int row>
inline float multiplyRow(const Matrix3& a, const Triple& v) {
  return static_cast<float>(a.m[row][0]) * v.v0 + static_cast<float>(a.m[row][1]) * v.v1 +
         static_cast<float>(a.m[row][2]) * v.v2;
}

inline Triple multiply(const Matrix3& a, const Triple& v) {
  return {multiplyRow<0>(a, v), multiplyRow<1>(a, v), multiplyRow<2>(a, v)};
}

inline float clamp01(float v) {
  const float atLeast0 = v > 0.0f ? v : 0.0f;
  return atLeast0 < 1.0f ? atLeast0 : 1.0f;
}

// (y, cx, cz) of linear RGB.
inline Triple opponentFromLinear(const Triple& rgb) {
  const Triple xyz = multiply(kXyzFromLinearRgb, rgb);
  return {xyz.v1, xyz.v0 - xyz.v1, xyz.v1 - xyz.v2};
}

// XYZ of the colour whose linear RGB is clamped to [0,1]. What clamping changes is added to XYZ, so that colours inside
// of the gamut keep their precision: the chroma of CIELAB magnifies the rounding of a way through RGB and back.
inline Triple clampedXyzFromOpponent(const Triple& opponent) {
  const Triple xyz{opponent.v0 + opponent.v1, opponent.v0, opponent.v0 - opponent.v2};
  const Triple rgb = multiply(kLinearRgbFromXyz, xyz);
  const Triple change =
      multiply(kXyzFromLinearRgb, {clamp01(rgb.v0) - rgb.v0, clamp01(rgb.v1) - rgb.v1, clamp01(rgb.v2) - rgb.v2});
  const auto positive = [](float v) { return v > 0.0f ? v : 0.0f; };
  return {positive(xyz.v0 + change.v0), positive(xyz.v1 + change.v1), positive(xyz.v2 + change.v2)};
}

// The compression of CIELAB, for v >= 0.
inline float labCompress(float v) {
  constexpr float d = 6.0f / 29.0f;
  const float root = fastCbrt(v);
  const float line = v * (1.0f / (3.0f * d * d)) + 4.0f / 29.0f;
  return v > d * d * d ? root : line;
}

// CIELAB (L, a, b) of XYZ, which is not negative.
inline Triple labFromXyz(const Triple& xyz) {
  const float fx = labCompress(xyz.v0), fy = labCompress(xyz.v1), fz = labCompress(xyz.v2);
  return {116.0f * fy - 16.0f, 500.0f * (fx - fy), 200.0f * (fy - fz)};
}

// Hunt effect: chroma shrinks with lightness.
inline Triple huntAdjusted(const Triple& lab) {
  const float scale = 0.01f * lab.v0;
  return {lab.v0, scale * lab.v1, scale * lab.v2};
}

// HyAB distance: city-block in lightness, Euclidean in chroma.
inline float hyab(const Triple& p, const Triple& q) {
  const float da = p.v1 - q.v1, db = p.v2 - q.v2;
  return std::fabs(p.v0 - q.v0) + std::sqrt(da * da + db * db);
}

}  // namespace pb::flip
