#include "bench/metrics/ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bench/metrics/checks.h"
#include "bench/metrics/tap_sums.h"
#include "bench/metrics/vector_clones.h"
#include "scenes/luminance.h"

namespace pb {
namespace {

using DoublePlane = Grid<double>;

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (0.01 L)^2 and (0.03 L)^2 with L = 1

// Rows per task: the margin of 2 kRadius rows costs little, and a band stays in a core's cache.
constexpr int kBandRows = 32;

constexpr int kScales = 5;
constexpr std::array<double, kScales> kScaleWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

// Similarity at each pixel whose window lies inside of the image; pixel (0,0) of a map is (5,5) of the image.
struct SimilarityMaps {
  DoublePlane ssim;
  DoublePlane contrastStructure;  // the factor without the means
};

// The weighted sums that SSIM needs of x and y: of x, y, x^2, y^2 and xy.
enum Moment { kX, kY, kXX, kYY, kXY, kMomentCount };

// Normalised Gaussian weights of offsets 0 to kRadius; half of the centre's, whose pair counts it twice.
std::array<double, kRadius + 1> windowWeights() {
  std::array<double, kRadius + 1> weights{};
  double sum = 0;
  for (int i = 0; i <= kRadius; ++i) {
    const double weight = std::exp(-0.5 * i * i / (kSigma * kSigma));
    weights[static_cast<std::size_t>(i)] = weight;
    sum += i == 0 ? weight : 2 * weight;
  }
  for (double& weight : weights) weight /= sum;
  weights[0] *= 0.5;
  return weights;
}

PB_VECTOR_CLONES void multiplyRows(const double* x, const double* y, int width, double* out) {
#pragma GCC ivdep
  for (int i = 0; i < width; ++i) out[i] = x[i] * y[i];
}

PB_VECTOR_CLONES void similarityRow(const std::array<const double*, kMomentCount>& moments, int width, double* ssim,
                                    double* contrastStructure) {
  const std::array<const double*, kMomentCount> m = moments;
#pragma GCC ivdep
  for (int i = 0; i < width; ++i) {
    const double mx = m[kX][i], my = m[kY][i];
    const double varianceX = m[kXX][i] - mx * mx, varianceY = m[kYY][i] - my * my;
    const double covariance = m[kXY][i] - mx * my;
    const double structure = (2 * covariance + kC2) / (varianceX + varianceY + kC2);
    contrastStructure[i] = structure;
    ssim[i] = (2 * mx * my + kC1) / (mx * mx + my * my + kC1) * structure;
  }
}

// Window sums over a band of rows of two planes.
class BandMoments {
 public:
  // Rows [firstRow, endRow) of the maps, so rows [firstRow, endRow + 2 kRadius) of the planes.
  BandMoments(const DoublePlane& x, const DoublePlane& y, int firstRow, int endRow)
      : width_(x.width()), firstRow_(firstRow) {
    const int rows = endRow - firstRow + 2 * kRadius;
    for (DoublePlane& products : products_) products = DoublePlane(width_, rows);
    for (int row = 0; row < rows; ++row) {
      const double* const xRow = &x(0, firstRow + row);
      const double* const yRow = &y(0, firstRow + row);
      std::copy(xRow, xRow + width_, &products_[kX](0, row));
      std::copy(yRow, yRow + width_, &products_[kY](0, row));
      multiplyRows(xRow, xRow, width_, &products_[kXX](0, row));
      multiplyRows(yRow, yRow, width_, &products_[kYY](0, row));
      multiplyRows(xRow, yRow, width_, &products_[kXY](0, row));
    }
  }

  void computeRow(int y, SimilarityMaps& maps) {
    std::array<const double*, kMomentCount> moments{};
    for (std::size_t moment = 0; moment < kMomentCount; ++moment) {
      moments[moment] = filterRow(products_[moment], y - firstRow_, sums_[moment]);
    }
    similarityRow(moments, maps.ssim.width(), &maps.ssim(0, y), &maps.contrastStructure(0, y));
  }

 private:
  const double* filterRow(const DoublePlane& products, int row, std::vector<double>& sum) {
    columnSums_.resize(static_cast<std::size_t>(width_));
    sumWindow([&](int i) { return &products(0, row + kRadius + i); }, width_, columnSums_.data());
    sum.resize(static_cast<std::size_t>(width_ - 2 * kRadius));
    sumWindow([&](int i) { return &columnSums_[static_cast<std::size_t>(kRadius + i)]; }, width_ - 2 * kRadius,
              sum.data());
    return sum.data();
  }

  template <class RowAt>
  static void sumWindow(RowAt rowAt, int width, double* out) {
    static const std::array<double, kRadius + 1> weights = windowWeights();
    std::array<TapPair<double>, kRadius + 1> taps{};
    for (int i = 0; i <= kRadius; ++i) {
      const auto index = static_cast<std::size_t>(i);
      taps[index] = {rowAt(-i), rowAt(i), weights[index]};
    }
    sumEvenTaps(taps, width, out);
  }

  int width_, firstRow_;
  std::array<DoublePlane, kMomentCount> products_;
  std::array<std::vector<double>, kMomentCount> sums_;
  std::vector<double> columnSums_;
};

bool hasWindow(int width, int height) { return std::min(width, height) > 2 * kRadius; }

SimilarityMaps similarityMaps(const DoublePlane& x, const DoublePlane& y) {
  const int width = x.width() - 2 * kRadius, height = x.height() - 2 * kRadius;
  SimilarityMaps maps{DoublePlane(width, height), DoublePlane(width, height)};
  const int bands = (height + kBandRows - 1) / kBandRows;
  tbb::parallel_for(0, bands, [&](int band) {
    const int firstRow = band * kBandRows, endRow = std::min(firstRow + kBandRows, height);
    BandMoments moments(x, y, firstRow, endRow);
    for (int row = firstRow; row < endRow; ++row) moments.computeRow(row, maps);
  });
  return maps;
}

template <class Value>
DoublePlane planeOf(const Image& image, Value value) {
  DoublePlane plane(image.width(), image.height());
  std::transform(image.begin(), image.end(), plane.begin(), value);
  return plane;
}

DoublePlane channelPlane(const Image& image, int channel) {
  return planeOf(image, [channel](const glm::vec3& pixel) { return double{pixel[channel]}; });
}

DoublePlane lumaPlane(const Image& image) {
  return planeOf(image, [](const glm::vec3& pixel) { return luminance(glm::dvec3(pixel)); });
}

double meanOf(const DoublePlane& map) {
  double sum = 0;
  for (const double value : map) sum += value;
  return sum / static_cast<double>(map.size());
}

bool isInside(const Mask& mask, int x, int y) { return mask(x + kRadius, y + kRadius) != 0; }

// nullopt where no pixel of the map is inside.
std::optional<double> meanInside(const DoublePlane& map, const Mask& mask) {
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (!isInside(mask, x, y)) continue;
      sum += map(x, y);
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

// Each output pixel is the mean of 2x2 input pixels; the sides are even.
DoublePlane halved(const DoublePlane& plane) {
  DoublePlane half(plane.width() / 2, plane.height() / 2);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      const double top = plane(2 * x, 2 * y) + plane(2 * x + 1, 2 * y);
      const double bottom = plane(2 * x, 2 * y + 1) + plane(2 * x + 1, 2 * y + 1);
      half(x, y) = 0.25 * (top + bottom);
    }
  }
  return half;
}

// Product over the scales of mean similarity ^ weight: contrast and structure at all but the coarsest, SSIM there.
// A negative mean, which has no real power, counts as 0.
double msSsimOfPlanes(DoublePlane x, DoublePlane y) {
  double product = 1;
  for (std::size_t scale = 0; scale < kScales; ++scale) {
    if (scale > 0) {
      x = halved(x);
      y = halved(y);
    }
    const SimilarityMaps maps = similarityMaps(x, y);
    const double mean = meanOf(scale + 1 < kScales ? maps.contrastStructure : maps.ssim);
    product *= std::pow(std::max(mean, 0.0), kScaleWeights[scale]);
  }
  return product;
}

}  // namespace

SsimMaps computeSsimMaps(const Image& reference, const Image& test) {
  requireComparable(reference, test);
  SsimMaps maps;
  if (!hasWindow(reference.width(), reference.height())) return maps;
  for (int channel = 0; channel < 3; ++channel) {
    maps.channels[static_cast<std::size_t>(channel)] =
        similarityMaps(channelPlane(reference, channel), channelPlane(test, channel)).ssim;
  }
  maps.luma = similarityMaps(lumaPlane(reference), lumaPlane(test)).ssim;
  return maps;
}

std::optional<Ssim> averageSsim(const SsimMaps& maps, const Mask* mask) {
  if (maps.luma.empty()) return std::nullopt;
  if (mask) requireMaskSize(*mask, maps.luma.width() + 2 * kRadius, maps.luma.height() + 2 * kRadius);
  const auto mean = [mask](const DoublePlane& map) { return mask ? meanInside(map, *mask) : meanOf(map); };
  const std::optional<double> luma = mean(maps.luma);
  if (!luma) return std::nullopt;
  Ssim result;
  result.luma = *luma;
  for (std::size_t channel = 0; channel < 3; ++channel) result.channels[channel] = *mean(maps.channels[channel]);
  result.mean = (result.channels[0] + result.channels[1] + result.channels[2]) / 3.0;
  return result;
}

std::optional<Ssim> computeSsim(const Image& reference, const Image& test, const Mask* mask) {
  requireComparable(reference, test);
  if (mask) requireMaskSize(*mask, reference.width(), reference.height());
  return averageSsim(computeSsimMaps(reference, test), mask);
}

std::optional<double> computeMsSsim(const Image& reference, const Image& test) {
  requireComparable(reference, test);
  const auto fits = [](int side) { return side % 16 == 0 && side >= 176; };
  if (!fits(reference.width()) || !fits(reference.height())) return std::nullopt;
  double sum = 0;
  for (int channel = 0; channel < 3; ++channel) {
    sum += msSsimOfPlanes(channelPlane(reference, channel), channelPlane(test, channel));
  }
  return sum / 3.0;
}

}  // namespace pb
