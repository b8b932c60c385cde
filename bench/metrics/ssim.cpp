#include "bench/metrics/ssim.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bench/metrics/checks.h"

namespace pb::ssim {
namespace {

constexpr int kScales = 5;
constexpr std::array<double, kScales> kScaleWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

constexpr std::size_t kMaxKeptBytes = std::size_t{512} << 20;

bool hasWindow(int width, int height) { return std::min(width, height) > 2 * kRadius; }

bool hasFiveScales(int width, int height) {
  const auto fits = [](int side) { return side % 16 == 0 && side >= 176; };
  return fits(width) && fits(height);
}

double mapSize(const PaddedPlane& plane) {
  return static_cast<double>(plane.width - 2 * kRadius) * static_cast<double>(plane.height() - 2 * kRadius);
}

// Means over `count` pixels of the first scale's maps.
Ssim meanSsim(const std::vector<TileSums>& sums, double TileSums::*member, double count) {
  Ssim result;
  for (std::size_t channel = 0; channel < 3; ++channel) result.channels[channel] = sums[channel].*member / count;
  result.mean = (result.channels[0] + result.channels[1] + result.channels[2]) / 3.0;
  result.luma = sums[kLumaPlane].*member / count;
  return result;
}

// Product over the scales of mean similarity ^ weight: contrast and structure at all but the coarsest, SSIM there.
// A negative mean, which has no real power, counts as 0.
double msSsimOfChannel(const Planes& planes, const std::vector<TileSums>& sums, std::size_t channel) {
  double product = 1;
  for (std::size_t scale = 0; scale < kScales; ++scale) {
    const std::size_t plane = planeIndex(scale, channel);
    const double sum = scale + 1 < kScales ? sums[plane].contrastStructure : sums[plane].ssim;
    product *= std::pow(std::max(sum / mapSize(planes[plane]), 0.0), kScaleWeights[scale]);
  }
  return product;
}

double sumOf(const Plane& weights) {
  double sum = 0;
  for (const float weight : weights) sum += double{weight};
  return sum;
}

}  // namespace

SsimReference::SsimReference(const Image& reference, Scales scales, Reuse reuse)
    : width_(reference.width()),
      height_(reference.height()),
      scales_(scales == Scales::all && hasFiveScales(width_, height_) ? kScales : 1) {
  if (!hasWindow(width_, height_)) return;
  planes_ = makePlanes(width_, height_, scales_);
  fillPlanes(reference, planes_);
  for (std::size_t plane = 0; plane < planes_.size(); ++plane) addTiles(plane);
  if (reuse == Reuse::never || tiles_.size() * sizeof(ReferenceTile) > kMaxKeptBytes) return;
  kept_.resize(tiles_.size());
  tbb::parallel_for(std::size_t{0}, tiles_.size(),
                    [&](std::size_t i) { computeReferenceTile(planes_[tiles_[i].plane], tiles_[i].tile, kept_[i]); });
}

void SsimReference::addTiles(std::size_t plane) {
  const int width = planes_[plane].width - 2 * kRadius, height = planes_[plane].height() - 2 * kRadius;
  for (int y = 0; y < height; y += kTileRows) {
    for (int x = 0; x < width; x += kTileWidth) {
      tiles_.push_back({plane, {x, y, std::min(kTileWidth, width - x), std::min(kTileRows, height - y)}});
    }
  }
}

// Tiles in parallel, then added in their order, which does not depend on the threads.
std::vector<TileSums> SsimReference::comparePlanes(const Planes& test, const PaddedPlane* weights) const {
  std::vector<TileSums> tileSums(tiles_.size());
  tbb::parallel_for(std::size_t{0}, tiles_.size(), [&](std::size_t i) {
    const auto& [plane, tile] = tiles_[i];
    const PaddedPlane* const planeWeights = plane < kFirstPlanes ? weights : nullptr;
    if (!kept_.empty()) {
      tileSums[i] = compareTile(planes_[plane], kept_[i], test[plane], planeWeights, tile);
      return;
    }
    ReferenceTile referenceTile;
    computeReferenceTile(planes_[plane], tile, referenceTile);
    tileSums[i] = compareTile(planes_[plane], referenceTile, test[plane], planeWeights, tile);
  });
  std::vector<TileSums> sums(planes_.size());
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    TileSums& sum = sums[tiles_[i].plane];
    sum.ssim += tileSums[i].ssim;
    sum.contrastStructure += tileSums[i].contrastStructure;
    sum.weightedSsim += tileSums[i].weightedSsim;
  }
  return sums;
}

Planes SsimReference::takePlanes() const {
  const std::lock_guard lock(mutex_);
  if (unused_.empty()) return makePlanes(width_, height_, scales_);
  Planes planes = std::move(unused_.back());
  unused_.pop_back();
  return planes;
}

void SsimReference::giveBack(Planes planes) const {
  const std::lock_guard lock(mutex_);
  unused_.push_back(std::move(planes));
}

Scores SsimReference::compare(const Image& test, const Mask* mask) const {
  Scores scores;
  if (planes_.empty()) return scores;
  std::optional<PaddedPlane> weights;
  if (mask) weights = makeMapWeights(*mask);
  Planes testPlanes = takePlanes();
  fillPlanes(test, testPlanes);
  const std::vector<TileSums> sums = comparePlanes(testPlanes, weights ? &*weights : nullptr);
  giveBack(std::move(testPlanes));
  scores.whole = meanSsim(sums, &TileSums::ssim, mapSize(planes_[0]));
  const double inside = weights ? sumOf(weights->values) : 0;
  if (inside > 0) scores.masked = meanSsim(sums, &TileSums::weightedSsim, inside);
  if (scales_ < kScales) return scores;
  double sum = 0;
  for (std::size_t channel = 0; channel < 3; ++channel) sum += msSsimOfChannel(planes_, sums, channel);
  scores.msSsim = sum / 3.0;
  return scores;
}

}  // namespace pb::ssim

namespace pb {

std::optional<Ssim> computeSsim(const Image& reference, const Image& test, const Mask* mask) {
  requireComparable(reference, test);
  if (mask) requireMaskSize(*mask, reference.width(), reference.height());
  const auto scores = ssim::SsimReference(reference, ssim::Scales::first, ssim::Reuse::never).compare(test, mask);
  return mask ? scores.masked : scores.whole;
}

std::optional<double> computeMsSsim(const Image& reference, const Image& test) {
  requireComparable(reference, test);
  if (!ssim::hasFiveScales(reference.width(), reference.height())) return std::nullopt;
  return ssim::SsimReference(reference, ssim::Scales::all, ssim::Reuse::never).compare(test, nullptr).msSsim;
}

}  // namespace pb
