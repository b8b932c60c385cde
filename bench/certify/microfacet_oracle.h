// The GGX lobe spelled a second time, in double precision and other variables, to check the shading model by.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pb::oracle {

inline constexpr double kPi = std::numbers::pi;

// Walter et al. 2007, eq. 33 in terms of the tangent.
inline double ggxDensity(double cosine, double alpha) {
  if (cosine <= 0.0) return 0.0;
  const double cos2 = cosine * cosine;
  const double tan2 = (1.0 - cos2) / cos2;
  const double s = alpha * alpha + tan2;
  return alpha * alpha / (kPi * cos2 * cos2 * s * s);
}

// 1 + Lambda, Walter et al. 2007, eq. 34 solved for it.
inline double onePlusLambda(double cosine, double alpha) {
  const double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
  return 0.5 * (1.0 + std::sqrt(1.0 + alpha * alpha * tan2));
}

// Calls f(microfacet normal's cosine, azimuth, weight) so that the weights add up to the integral of D cosine over the
// hemisphere, which is 1. The cosine's distribution function is u = 1 / (1 + alpha^2 / tan^2); u = 1 - (1 - w)^2 takes
// away the root that integrands over the cosine have at the horizon.
template <class F>
void forEachMicrofacet(double alpha, int steps, const F& f) {
  for (int i = 0; i < steps; ++i) {
    const double w = (i + 0.5) / steps;
    const double u = 1.0 - (1.0 - w) * (1.0 - w);
    const double tan2 = alpha * alpha * u / (1.0 - u);
    for (int j = 0; j < steps; ++j)
      f(1.0 / std::sqrt(1.0 + tan2), 2.0 * kPi * (j + 0.5) / steps,
        2.0 * (1.0 - w) / (steps * static_cast<double>(steps)));
  }
}

// Share of uniform light that the lobe reflects towards a viewer at cosine NoV, split as x F0 + y F90 with Schlick's
// Fresnel: the integral over microfacets of D G2 VoH / NoV.
struct Albedo {
  double x = 0.0, y = 0.0;
};
inline Albedo directionalAlbedo(double NoV, double alpha, int steps = 512) {
  const double sinV = std::sqrt(std::max(1.0 - NoV * NoV, 0.0));
  Albedo albedo;
  forEachMicrofacet(alpha, steps, [&](double NoH, double phi, double weight) {
    const double VoH = NoV * NoH + sinV * std::sqrt(std::max(1.0 - NoH * NoH, 0.0)) * std::cos(phi);
    const double NoL = 2.0 * VoH * NoH - NoV;
    if (VoH <= 0.0 || NoL <= 0.0) return;
    const double g = 1.0 / (onePlusLambda(NoV, alpha) + onePlusLambda(NoL, alpha) - 1.0);
    const double value = weight * g * VoH / (NoV * NoH);
    const double rise = std::pow(1.0 - VoH, 5.0);
    albedo.x += value * (1.0 - rise);
    albedo.y += value * rise;
  });
  return albedo;
}

}  // namespace pb::oracle
