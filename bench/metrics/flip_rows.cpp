#include "bench/metrics/flip_rows.h"

#include <cmath>

#include "bench/metrics/flip_color.h"
#include "bench/metrics/vector_clones.h"

namespace pb::flip {
namespace {

constexpr float kColorExponent = 0.7f;               // q_c
constexpr float kMaxColorError = 41.276098f;         // HyAB distance of green and blue, 203.301655, to the power q_c
constexpr float kColorKnee = 0.4f * kMaxColorError;  // p_c: this colour error ...
constexpr float kErrorAtKnee = 0.95f;                // p_t: ... becomes this

constexpr float kEqualColors = 1e-30f;

// Exposed values are clamped to this so that their squares stay finite; every curve has long reached its limit.
constexpr float kMaxExposed = 1e15f;

inline float exposed(float value, float gain) {
  const float product = value * gain;
  return product < kMaxExposed ? product : kMaxExposed;
}

inline void storeOpponent(const Triple& rgb, int x, const Row3& out) {
  const Triple opponent = opponentFromLinear({clamp01(rgb.v0), clamp01(rgb.v1), clamp01(rgb.v2)});
  out[0][x] = opponent.v0;
  out[1][x] = opponent.v1;
  out[2][x] = opponent.v2;
}

// Colour difference in [0,1] of a HyAB distance: its q_c-th power, compressed above the knee.
inline float colorDifference(float distance) {
  const float e = fastPow(distance, kColorExponent);
  const float low = e * (kErrorAtKnee / kColorKnee);
  const float high = kErrorAtKnee + (e - kColorKnee) * ((1.0f - kErrorAtKnee) / (kMaxColorError - kColorKnee));
  return e < kColorKnee ? low : high;
}

}  // namespace

PB_VECTOR_CLONES void splitChannels(const float* rgb, int width, const Row3& out) {
  float* const r = out[0];
  float* const g = out[1];
  float* const b = out[2];
  for (int x = 0; x < width; ++x) {
    r[x] = rgb[3 * x] > 0.0f ? rgb[3 * x] : 0.0f;
    g[x] = rgb[3 * x + 1] > 0.0f ? rgb[3 * x + 1] : 0.0f;
    b[x] = rgb[3 * x + 2] > 0.0f ? rgb[3 * x + 2] : 0.0f;
  }
}

PB_VECTOR_CLONES void clampToOpponent(const ConstRow3& rgb, int width, const Row3& opponent) {
  const ConstRow3 in = rgb;
  const Row3 out = opponent;
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) storeOpponent({in[0][x], in[1][x], in[2][x]}, x, out);
}

PB_VECTOR_CLONES void curveToOpponent(const ConstRow3& rgb, float gain, const RationalCurve& curve, int width,
                                      const Row3& opponent) {
  const ConstRow3 in = rgb;
  const Row3 out = opponent;
  const auto k0 = static_cast<float>(curve.k0), k1 = static_cast<float>(curve.k1), k2 = static_cast<float>(curve.k2);
  const auto k3 = static_cast<float>(curve.k3), k4 = static_cast<float>(curve.k4), k5 = static_cast<float>(curve.k5);
  const auto toneMapped = [=](float value) {
    const float v = exposed(value, gain);
    return ((k0 * v + k1) * v + k2) / ((k3 * v + k4) * v + k5);
  };
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    storeOpponent({toneMapped(in[0][x]), toneMapped(in[1][x]), toneMapped(in[2][x])}, x, out);
  }
}

PB_VECTOR_CLONES void reinhardToOpponent(const ConstRow3& rgb, float gain, int width, const Row3& opponent) {
  const ConstRow3 in = rgb;
  const Row3 out = opponent;
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const Triple v{exposed(in[0][x], gain), exposed(in[1][x], gain), exposed(in[2][x], gain)};
    const float scale = 1.0f / (1.0f + 0.2126f * v.v0 + 0.7152f * v.v1 + 0.0722f * v.v2);
    storeOpponent({v.v0 * scale, v.v1 * scale, v.v2 * scale}, x, out);
  }
}

PB_VECTOR_CLONES void opponentToLab(const ConstRow4& filtered, int width, const FeatureRow& out) {
  const ConstRow4 in = filtered;
  float* const lightness = out.lightness;
  float* const a = out.a;
  float* const b = out.b;
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const Triple lab = huntAdjusted(labFromXyz(clampedXyzFromOpponent({in[0][x], in[1][x], in[2][x] + in[3][x]})));
    lightness[x] = lab.v0;
    a[x] = lab.v1;
    b[x] = lab.v2;
  }
}

PB_VECTOR_CLONES void magnitude(const float* x, const float* y, int width, float* out) {
#pragma GCC ivdep
  for (int i = 0; i < width; ++i) out[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
}

PB_VECTOR_CLONES void flipError(const ConstFeatureRow& reference, const ConstFeatureRow& test, int width,
                                float* error) {
  const ConstFeatureRow r = reference, t = test;
  constexpr float kSqrtHalf = 0.707106781f;
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const float distance = hyab({r.lightness[x], r.a[x], r.b[x]}, {t.lightness[x], t.a[x], t.b[x]});
    const float edge = std::fabs(r.edge[x] - t.edge[x]), point = std::fabs(r.point[x] - t.point[x]);
    const float feature = std::sqrt(kSqrtHalf * (edge > point ? edge : point));  // q_f = 0.5
    const float value = fastPow(colorDifference(distance), 1.0f - feature);
    // fastPow needs a positive base: equal colours have error 0 whatever their features. Rounding may exceed 1.
    error[x] = distance > kEqualColors ? (value < 1.0f ? value : 1.0f) : 0.0f;
  }
}

PB_VECTOR_CLONES void keepLargest(const float* error, float exposure, int width, float* largest,
                                  float* exposureOfLargest) {
#pragma GCC ivdep
  for (int x = 0; x < width; ++x) {
    const bool larger = error[x] > largest[x];
    largest[x] = larger ? error[x] : largest[x];
    exposureOfLargest[x] = larger ? exposure : exposureOfLargest[x];
  }
}

}  // namespace pb::flip
