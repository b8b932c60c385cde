// Image error metrics: pure functions of a reference and a test image. Definitions and tolerances: docs/metrics.md.
//
// All take two images of equal, non-zero size and throw an input Error otherwise, or when either holds a NaN or an
// infinity (the message names the image and the first such pixel). Sums are in double precision and in a fixed order:
// the same bits for any number of threads.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scenes/image.h"

namespace pb {

using Mask = Grid<unsigned char>;  // non-zero: inside

// Means over pixels and channels, d = test - reference, r = reference. Never leaves a pixel out.
struct ErrorSums {
  double bias = 0;  // mean d
  double mse = 0;   // mean d^2
  double rmse = 0;
  double mae = 0;     // mean |d|
  double maxAbs = 0;  // max |d|
  double psnr = 0;    // 10 log10(1 / mse); +infinity for equal images
  double relmse = 0;  // mean d^2 / (r^2 + 0.01)
  double smape = 0;   // mean |d| / (|r| + |t| + 0.01)
};
ErrorSums computeErrorSums(const Image& reference, const Image& test, const Mask* mask = nullptr);

// Wang et al. 2004, Gaussian window sigma 1.5, radius 5, L = 1. nullopt where a side is shorter than 11 pixels, or
// where the mask holds no pixel that is at least 5 from the border.
struct Ssim {
  std::array<double, 3> channels{};
  double mean = 0;  // of the channels
  double luma = 0;
};
std::optional<Ssim> computeSsim(const Image& reference, const Image& test, const Mask* mask = nullptr);

// Wang et al. 2003, five scales. nullopt unless both sides are multiples of 16 and at least 176.
std::optional<double> computeMsSsim(const Image& reference, const Image& test);

// FLIP, Andersson et al. 2020 (LDR) and 2021 (HDR).
enum class ToneMapper { aces, hable, reinhard };

struct FlipSettings {
  double ppd = 67.02064327658225;  // pixels per degree: 0.7 m from a 0.7 m wide 3840 pixel monitor
  ToneMapper toneMapper = ToneMapper::aces;
  std::optional<double> startExposure, stopExposure;  // HDR; otherwise from the reference
  std::optional<int> numExposures;
};

struct FlipResult {
  Plane map;          // [0,1]
  Plane exposureMap;  // HDR: index of the exposure of the maximum / (n - 1)
  double ppd = 0;
  double startExposure = 0, stopExposure = 0;  // HDR
  int numExposures = 0;                        // HDR
};

// Linear inputs, clamped to [0,1].
FlipResult computeFlipLdr(const Image& reference, const Image& test, const FlipSettings& settings = {});

// Linear inputs, negatives clamped to 0. Where the reference's median luminance is 0 and no stop exposure is given, the
// median of the positive luminances takes its place; a reference without any positive luminance uses exposure 0 alone
// twice.
FlipResult computeFlipHdr(const Image& reference, const Image& test, const FlipSettings& settings = {});

struct FlipPooled {
  double mean = 0, weightedQ1 = 0, weightedMedian = 0, weightedQ3 = 0, min = 0, max = 0;
};
FlipPooled poolFlip(const Plane& map, const Mask* mask = nullptr);

// Everything `compare` prints and results.json holds. FLIP and SSIM maps are made of whole images, then averaged over
// the mask.
struct Metrics {
  ErrorSums sums;
  std::optional<Ssim> ssim;
  std::optional<double> msSsim;
  FlipPooled flipLdr;
  std::optional<FlipPooled> flipHdr;  // absent for 8-bit input
  double ppd = 0;
  double startExposure = 0, stopExposure = 0;
  int numExposures = 0;
};

// Metrics of one pair over the whole image and over each mask, the maps made once.
struct MetricsInput {
  const Image& reference;  // scene-referred linear, or sRGB-encoded values if srgb is set
  const Image& test;
  bool srgb = false;    // 8-bit values: sums and SSIM on encoded values, LDR-FLIP on decoded ones, no HDR-FLIP
  double exposure = 0;  // stops applied before LDR-FLIP, PSNR and SSIM
  bool clampForDisplay =
      false;  // PSNR and SSIM on values clamped to [0,1] after exposure, as tables do; `compare` never does
  FlipSettings flip{};
};
struct MetricsResult {
  Metrics whole;
  std::optional<Metrics> masked;  // absent without a mask or when the mask is empty
  Plane flipLdrMap, flipHdrMap;   // flipHdrMap empty for 8-bit input
};
MetricsResult computeMetrics(const MetricsInput& input, const Mask* mask = nullptr);

// Error maps as pictures: magma for errors, viridis for exposures (matplotlib's CC0 colour maps). Values encoded as
// shown.
Image magma(const Plane& map);
Image viridis(const Plane& map);

// One line of the table of metrics: how to read a number out of Metrics by the key used in results.json and tolerances.
struct MetricInfo {
  std::string key;  // "relmse", "flip_hdr", ...
  bool lowerIsBetter;
  std::string description;  // formula and source, one line
  std::optional<double> (*value)(const Metrics&);
};
const std::vector<MetricInfo>& metricTable();

}  // namespace pb
