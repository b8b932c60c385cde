#include "bench/metrics/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "bench/metrics/checks.h"
#include "scenes/error.h"

namespace pb::flip {
namespace {

// Rows per task: enough to spread the cost of the filters' margin, few enough for a band to stay in a core's cache.
constexpr int kBandRows = 32;

constexpr std::size_t kMaxKeptBytes = std::size_t{512} << 20;

constexpr double kMinPpd = 1, kMaxPpd = 1000;

Kernels checkedKernels(double ppd) {
  if (!(ppd >= kMinPpd && ppd <= kMaxPpd)) {
    throwInputError("FLIP's pixels per degree must lie in [{}, {}], got {}", kMinPpd, kMaxPpd, ppd);
  }
  return makeKernels(ppd);
}

}  // namespace

FlipReference::FlipReference(const Image& reference, Mode mode, const FlipSettings& settings, Reuse reuse)
    : reference_(reference), mode_(mode), settings_(settings), kernels_(checkedKernels(settings.ppd)) {
  requireFinite(reference, "reference");
  if (mode == Mode::hdr) exposures_ = chooseExposures(reference, settings);
  const std::size_t values = featureIndex(exposureCount(), 0);
  if (reuse == Reuse::ifSmall && values * sizeof(float) <= kMaxKeptBytes) {
    features_.resize(values);
    keepFeatures();
  }
}

Display FlipReference::displayAt(int exposure) const {
  if (mode_ == Mode::ldr) return {};
  return {settings_.toneMapper, static_cast<float>(std::exp2(exposures_[exposure]))};
}

float FlipReference::exposureFraction(int exposure) const {
  return exposures_.count > 1 ? static_cast<float>(exposure) / static_cast<float>(exposures_.count - 1) : 0.0f;
}

std::size_t FlipReference::featureIndex(int exposure, int y) const {
  const std::size_t row =
      static_cast<std::size_t>(exposure) * static_cast<std::size_t>(reference_.height()) + static_cast<std::size_t>(y);
  return row * kFeatureCount * static_cast<std::size_t>(reference_.width());
}

template <class Body>
void FlipReference::forEachBand(Body body) const {
  const int bands = (reference_.height() + kBandRows - 1) / kBandRows;
  tbb::parallel_for(0, bands, [&](int i) {
    body(Band{i * kBandRows, std::min((i + 1) * kBandRows, reference_.height())});
  });
}

void FlipReference::keepFeatures() {
  forEachBand([&](const Band& band) {
    BandFeatures bandFeatures(kernels_, reference_, band.firstRow, band.endRow);
    for (int exposure = 0; exposure < exposureCount(); ++exposure) {
      bandFeatures.setDisplay(displayAt(exposure));
      for (int y = band.firstRow; y < band.endRow; ++y) {
        bandFeatures.computeRow(y, &features_[featureIndex(exposure, y)]);
      }
    }
  });
}

void FlipReference::compareBand(const Band& band, const Image& test, FlipResult& result) const {
  const int width = test.width();
  BandFeatures testBand(kernels_, test, band.firstRow, band.endRow);
  std::optional<BandFeatures> referenceBand;
  if (features_.empty()) referenceBand.emplace(kernels_, reference_, band.firstRow, band.endRow);
  std::vector<float> testRow(featureIndex(0, 1)), referenceRow(featureIndex(0, 1));
  std::vector<float> error(static_cast<std::size_t>(width));

  const auto referenceFeatures = [&](int exposure, int y) -> const float* {
    if (!referenceBand) return &features_[featureIndex(exposure, y)];
    referenceBand->computeRow(y, referenceRow.data());
    return referenceRow.data();
  };

  for (int exposure = 0; exposure < exposureCount(); ++exposure) {
    testBand.setDisplay(displayAt(exposure));
    if (referenceBand) referenceBand->setDisplay(displayAt(exposure));
    for (int y = band.firstRow; y < band.endRow; ++y) {
      testBand.computeRow(y, testRow.data());
      flipError({referenceFeatures(exposure, y), width}, {testRow.data(), width}, width, error.data());
      keepLargest(error.data(), exposureFraction(exposure), width, &result.map(0, y), &result.exposureMap(0, y));
    }
  }
}

FlipResult FlipReference::compare(const Image& test) const {
  requireComparable(reference_, test);
  FlipResult result;
  result.map = Plane(test.width(), test.height());
  result.exposureMap = Plane(test.width(), test.height());
  result.ppd = settings_.ppd;
  result.startExposure = exposures_.start;
  result.stopExposure = exposures_.stop;
  result.numExposures = exposures_.count;
  forEachBand([&](const Band& band) { compareBand(band, test, result); });
  if (mode_ == Mode::ldr) result.exposureMap = {};
  return result;
}

}  // namespace pb::flip

namespace pb {

FlipResult computeFlipLdr(const Image& reference, const Image& test, const FlipSettings& settings) {
  requireComparable(reference, test);
  return flip::FlipReference(reference, flip::Mode::ldr, settings, flip::Reuse::never).compare(test);
}

FlipResult computeFlipHdr(const Image& reference, const Image& test, const FlipSettings& settings) {
  requireComparable(reference, test);
  return flip::FlipReference(reference, flip::Mode::hdr, settings, flip::Reuse::never).compare(test);
}

}  // namespace pb
