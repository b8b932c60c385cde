// Image error metrics: pure functions of a reference and a test image. Definitions and tolerances: docs/metrics.md.
//
// All take two images of equal, non-zero size and throw an input Error otherwise, or when either holds a NaN or an
// infinity (the message names the image and the first such pixel). A mask has the size of the images and, unless said
// otherwise, at least one pixel inside; anything else is an input Error too. Sums are in double precision and in a
// fixed order: the same bits for any number of threads.
#pragma once

#include <array>
#include <memory>
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

// Values outside of the given ranges, and a start exposure above the stop exposure, are input Errors.
struct FlipSettings {
  double ppd = 67.02064327658225;  // pixels per degree, 1 to 1000: 0.7 m from a 0.7 m wide 3840 pixel monitor
  ToneMapper toneMapper = ToneMapper::aces;
  std::optional<double> startExposure{}, stopExposure{};  // HDR, stops, -120 to 120; otherwise from the reference
  std::optional<int> numExposures{};                      // HDR, 1 to 1000; otherwise max(2, ceil(stop - start))
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

// Linear inputs, negatives clamped to 0. The exposures that are not given come from the reference's largest and median
// luminance and are clamped to -120 to 120 stops. A median of 0 (at least half of the reference is black) is replaced
// by the median of the positive luminances, because the stop exposure would be infinite; a reference without any
// positive luminance has both exposures at 0, or both at the one that is given.
FlipResult computeFlipHdr(const Image& reference, const Image& test, const FlipSettings& settings = {});

// Pooled values of a map: the mean is the recommended single number. A weighted percentile p is the first of the
// ascending values at which their running sum exceeds p times their total; 0 for a map of zeros. Values are not
// negative.
struct FlipPooled {
  double mean = 0, weightedQ1 = 0, weightedMedian = 0, weightedQ3 = 0, min = 0, max = 0;
};
FlipPooled poolFlip(const Plane& map, const Mask* mask = nullptr);

// Everything `compare` prints and results.json holds: one number per metric through metricTable(), and the pooled
// values and settings of FLIP as members. FLIP and SSIM maps are made of whole images, then averaged over the mask;
// MS-SSIM is not defined on a mask, hence absent there.
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
  double exposure = 0;  // stops applied before LDR-FLIP, PSNR, SSIM and MS-SSIM; no effect on sRGB values
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

// What MetricsInput holds beside the images.
struct MetricsSettings {
  bool srgb = false;
  double exposure = 0;
  bool clampForDisplay = false;
  FlipSettings flip{};
};

// Scores many test images against one reference: the values of computeMetrics, bit for bit, with the reference's side
// of both FLIPs done once. That side takes 20 bytes per pixel and exposure; where this is more than 512 MiB it is not
// kept but recomputed. Immutable: compare() may be called from several threads at once, copies share the content.
class PreparedReference;
class MetricsReference {
 public:
  explicit MetricsReference(const Image& reference, const MetricsSettings& settings = {});
  MetricsResult compare(const Image& test, const Mask* mask = nullptr) const;

 private:
  std::shared_ptr<const PreparedReference> prepared_;
};

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
