#include "bench/metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/metrics/checks.h"
#include "bench/metrics/error_sums.h"
#include "bench/metrics/flip.h"
#include "bench/metrics/ssim.h"
#include "bench/metrics/vector_clones.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

template <class Function>
Image mapped(const Image& image, Function function) {
  Image result(image.width(), image.height());
  std::transform(image.begin(), image.end(), result.begin(), [&](const glm::vec3& pixel) {
    return glm::vec3(function(pixel.x), function(pixel.y), function(pixel.z));
  });
  return result;
}

Image decoded(const Image& encoded) { return mapped(encoded, linearFromSrgb); }

bool changesOnDisplay(const MetricsSettings& settings) {
  return !settings.srgb && (settings.exposure != 0 || settings.clampForDisplay);
}

PB_VECTOR_CLONES void displayValues(const float* values, std::size_t count, float gain, bool clamp, float* out) {
  if (!clamp) {
    for (std::size_t i = 0; i < count; ++i) out[i] = values[i] * gain;
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const float value = values[i] * gain, atLeast0 = value > 0.0f ? value : 0.0f;
    out[i] = atLeast0 < 1.0f ? atLeast0 : 1.0f;
  }
}

Image displayed(const Image& image, const MetricsSettings& settings) {
  Image result(image.width(), image.height());
  const auto gain = static_cast<float>(std::exp2(settings.exposure));
  displayValues(&image[0].x, 3 * image.size(), gain, settings.clampForDisplay, &result[0].x);
  return result;
}

// The values that PSNR and SSIM see, and those that LDR-FLIP sees: the same unless they must be decoded first. The
// image must outlive the object.
class DisplayedImage {
 public:
  DisplayedImage(const Image& image, const MetricsSettings& settings) : stored_(image) {
    if (changesOnDisplay(settings)) displayed_ = displayed(image, settings);
    if (settings.srgb) decoded_ = decoded(image);
  }
  const Image& values() const { return displayed_ ? *displayed_ : stored_; }
  const Image& linear() const { return decoded_ ? *decoded_ : values(); }

 private:
  const Image& stored_;
  std::optional<Image> displayed_, decoded_;
};

bool isEmpty(const Mask& mask) {
  return std::all_of(mask.begin(), mask.end(), [](unsigned char inside) { return inside == 0; });
}

// Everything about a pair that its metrics over several regions share.
struct PairMaps {
  const Image& reference;
  const Image& test;
  const Image& displayedReference;
  const Image& displayedTest;
  ssim::Scores ssim;
  FlipResult flipLdr;
  std::optional<FlipResult> flipHdr;
};

Metrics metricsOver(const PairMaps& maps, const Mask* mask) {
  Metrics metrics;
  metrics.sums = errorSumsOf(maps.reference, maps.test, mask);
  if (&maps.displayedReference != &maps.reference) {
    metrics.sums.psnr = psnrOf(maps.displayedReference, maps.displayedTest, mask);
  }
  metrics.ssim = mask ? maps.ssim.masked : maps.ssim.whole;
  if (!mask) metrics.msSsim = maps.ssim.msSsim;
  metrics.flipLdr = poolFlip(maps.flipLdr.map, mask);
  metrics.ppd = maps.flipLdr.ppd;
  if (maps.flipHdr) {
    metrics.flipHdr = poolFlip(maps.flipHdr->map, mask);
    metrics.startExposure = maps.flipHdr->startExposure;
    metrics.stopExposure = maps.flipHdr->stopExposure;
    metrics.numExposures = maps.flipHdr->numExposures;
  }
  return metrics;
}

}  // namespace

// The reference and what is made of it alone.
class PreparedReference {
 public:
  PreparedReference(const Image& image, const MetricsSettings& settings, flip::Reuse reuse)
      : settings_(settings),
        reference_(image),
        displayed_(image, settings),
        ssim_(displayed_.values(), ssim::Scales::all,
              reuse == flip::Reuse::never ? ssim::Reuse::never : ssim::Reuse::ifSmall),
        flipLdr_(displayed_.linear(), flip::Mode::ldr, settings.flip, reuse) {
    if (!settings.srgb) flipHdr_.emplace(reference_, flip::Mode::hdr, settings.flip, reuse);
  }
  PreparedReference(const PreparedReference&) = delete;
  PreparedReference& operator=(const PreparedReference&) = delete;

  MetricsResult compare(const Image& test, const Mask* mask) const;

 private:
  MetricsSettings settings_;
  Image reference_;
  DisplayedImage displayed_;
  ssim::SsimReference ssim_;
  flip::FlipReference flipLdr_;  // both refer to the images above
  std::optional<flip::FlipReference> flipHdr_;
};

MetricsResult PreparedReference::compare(const Image& test, const Mask* mask) const {
  requireComparable(reference_, test);
  if (mask) requireMaskSize(*mask, reference_.width(), reference_.height());
  const DisplayedImage displayedTest(test, settings_);
  PairMaps maps{.reference = reference_,
                .test = test,
                .displayedReference = displayed_.values(),
                .displayedTest = displayedTest.values(),
                .ssim = ssim_.compare(displayedTest.values(), mask),
                .flipLdr = flipLdr_.compare(displayedTest.linear()),
                .flipHdr = std::nullopt};
  if (flipHdr_) maps.flipHdr = flipHdr_->compare(test);

  MetricsResult result;
  result.whole = metricsOver(maps, nullptr);
  if (mask && !isEmpty(*mask)) result.masked = metricsOver(maps, mask);
  result.flipLdrMap = std::move(maps.flipLdr.map);
  if (maps.flipHdr) result.flipHdrMap = std::move(maps.flipHdr->map);
  return result;
}

MetricsReference::MetricsReference(const Image& reference, const MetricsSettings& settings)
    : prepared_(std::make_shared<const PreparedReference>(reference, settings, flip::Reuse::ifSmall)) {}

MetricsResult MetricsReference::compare(const Image& test, const Mask* mask) const {
  return prepared_->compare(test, mask);
}

MetricsResult computeMetrics(const MetricsInput& input, const Mask* mask) {
  const MetricsSettings settings{
      .srgb = input.srgb, .exposure = input.exposure, .clampForDisplay = input.clampForDisplay, .flip = input.flip};
  requireComparable(input.reference, input.test);
  return PreparedReference(input.reference, settings, flip::Reuse::never).compare(input.test, mask);
}

}  // namespace pb
