// The tone mappers of HDR-FLIP and the exposures at which it looks at a pair (Andersson et al. 2021).
#pragma once

#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb::flip {

// (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5)
struct RationalCurve {
  double k0, k1, k2, k3, k4, k5;
};

// ACES and Hable apply their curve to each channel. Reinhard divides by 1 + luminance; its curve is that of a grey.
RationalCurve toneCurve(ToneMapper toneMapper);

// The positive x at which the curve reaches `level`.
double inverseToneCurve(const RationalCurve& curve, double level);

struct ExposureRange {
  double start = 0, stop = 0;  // stops
  int count = 0;

  double step() const { return count > 1 ? (stop - start) / (count - 1) : 0.0; }
  double operator[](int i) const { return start + i * step(); }
};

// Settings as given, the rest from the reference's luminances; see computeFlipHdr for black references and limits.
ExposureRange chooseExposures(const Image& reference, const FlipSettings& settings);

}  // namespace pb::flip
