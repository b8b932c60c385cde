// Error sums, SSIM and the set of all metrics: hand-checkable values, masks, bad input, equal bits.
#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/unit/metrics/images.h"

namespace pb::test {
namespace {

using testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Two pixels, errors +0.5 in one channel and -1 in another.
Image twoPixels(glm::vec3 left, glm::vec3 right) {
  Image image(2, 1);
  image(0, 0) = left;
  image(1, 0) = right;
  return image;
}

TEST(ErrorSums, MatchHandComputedValues) {
  const Image reference = twoPixels({1, 2, 0}, {4, 0, 0}), test = twoPixels({1.5f, 2, 0}, {3, 0, 0});
  const ErrorSums sums = computeErrorSums(reference, test);
  EXPECT_DOUBLE_EQ(sums.bias, (0.5 - 1.0) / 6);
  EXPECT_DOUBLE_EQ(sums.mse, 1.25 / 6);
  EXPECT_DOUBLE_EQ(sums.rmse, std::sqrt(1.25 / 6));
  EXPECT_DOUBLE_EQ(sums.mae, 1.5 / 6);
  EXPECT_DOUBLE_EQ(sums.maxAbs, 1);
  EXPECT_DOUBLE_EQ(sums.psnr, 10 * std::log10(6 / 1.25));
  EXPECT_DOUBLE_EQ(sums.relmse, (0.25 / 1.01 + 1 / 16.01) / 6);
  EXPECT_DOUBLE_EQ(sums.smape, (0.5 / 2.51 + 1 / 7.01) / 6);
}

TEST(ErrorSums, OfSwappedImages_HaveOppositeBias) {
  const Image a = noiseImage(20, 10, 1), b = noiseImage(20, 10, 2);
  EXPECT_DOUBLE_EQ(computeErrorSums(a, b).bias, -computeErrorSums(b, a).bias);
  EXPECT_NE(computeErrorSums(a, b).bias, 0);
}

TEST(ErrorSums, OfEqualImages_AreZeroWithInfinitePsnr) {
  const Image image = noiseImage(20, 10, 1);
  const ErrorSums sums = computeErrorSums(image, image);
  EXPECT_EQ(sums.mse, 0);
  EXPECT_EQ(sums.maxAbs, 0);
  EXPECT_EQ(sums.relmse, 0);
  EXPECT_EQ(sums.psnr, std::numeric_limits<double>::infinity());
}

TEST(ErrorSums, OfBlackReference_AreDefined) {
  const ErrorSums sums = computeErrorSums(Image(4, 4), constantImage(4, 4, glm::vec3(0.5f)));
  EXPECT_DOUBLE_EQ(sums.relmse, 0.25 / 0.01);
  EXPECT_DOUBLE_EQ(sums.smape, 0.5 / 0.51);
}

TEST(ErrorSums, OverMask_AreThoseOfItsPixels) {
  const Image reference = twoPixels({1, 2, 0}, {4, 0, 0}), test = twoPixels({1.5f, 2, 0}, {3, 0, 0});
  Mask right(2, 1);
  right(1, 0) = 7;
  const ErrorSums sums = computeErrorSums(reference, test, &right);
  EXPECT_DOUBLE_EQ(sums.bias, -1.0 / 3);
  EXPECT_DOUBLE_EQ(sums.mse, 1.0 / 3);
  EXPECT_DOUBLE_EQ(sums.maxAbs, 1);
}

TEST(ErrorSums, OverUnfitMask_AreInputErrors) {
  const Image image(4, 3);
  const Mask empty(4, 3), otherSize(3, 4, 1);
  EXPECT_THAT([&] { computeErrorSums(image, image, &empty); }, throwsInputError(HasSubstr("at least one pixel")));
  EXPECT_THAT([&] { computeErrorSums(image, image, &otherSize); }, throwsInputError(HasSubstr("3x4")));
}

// With constant images the window sees no variance: S = (2 a b + C1) / (a^2 + b^2 + C1).
TEST(Ssim, OfConstants_MatchesClosedForm) {
  const double a = 0.25, b = 0.75, c1 = 1e-4;
  const auto ssim = computeSsim(constantImage(20, 15, glm::vec3(0.25f)), constantImage(20, 15, glm::vec3(0.75f)));
  ASSERT_TRUE(ssim);
  EXPECT_NEAR(ssim->mean, (2 * a * b + c1) / (a * a + b * b + c1), 1e-12);
  EXPECT_NEAR(ssim->luma, ssim->mean, 1e-12);
}

TEST(Ssim, OfEqualImages_IsOne) {
  const Image image = noiseImage(40, 30, 1);
  EXPECT_DOUBLE_EQ(computeSsim(image, image)->mean, 1);
  EXPECT_LT(computeSsim(image, noiseImage(40, 30, 2))->mean, 0.5);
}

TEST(Ssim, WhereASideIsShorterThanTheWindow_IsAbsent) {
  const auto defined = [](int width, int height) {
    return computeSsim(Image(width, height), Image(width, height)).has_value();
  };
  EXPECT_TRUE(defined(11, 11));
  EXPECT_FALSE(defined(10, 11));
  EXPECT_FALSE(defined(11, 10));
  EXPECT_FALSE(defined(1, 1));
}

// An error in the right half leaves windows that lie in the left half alone.
TEST(Ssim, OverMask_AveragesTheWholeImagesMap) {
  const Image reference = noiseImage(60, 20, 1);
  Image test = reference;
  for (int x = 30; x < 60; ++x) test(x, 10) = glm::vec3(0);
  Mask left(60, 20), everywhere(60, 20, 1);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 25; ++x) left(x, y) = 1;
  }
  EXPECT_DOUBLE_EQ(computeSsim(reference, test, &left)->mean, 1);
  EXPECT_DOUBLE_EQ(computeSsim(reference, test, &everywhere)->mean, computeSsim(reference, test)->mean);
  EXPECT_LT(computeSsim(reference, test)->mean, 0.99);
}

TEST(Ssim, OverMaskOfBorderPixelsOnly_IsAbsent) {
  const Image image = noiseImage(20, 20, 1);
  Mask mask(20, 20);
  mask(4, 10) = 1;
  EXPECT_FALSE(computeSsim(image, image, &mask));
  mask(5, 10) = 1;
  EXPECT_TRUE(computeSsim(image, image, &mask));
}

TEST(MsSsim, IsDefinedForSidesOfMultiplesOf16FromEleven16s) {
  const auto defined = [](int width, int height) {
    return computeMsSsim(Image(width, height), Image(width, height)).has_value();
  };
  EXPECT_TRUE(defined(176, 192));
  EXPECT_FALSE(defined(160, 192));
  EXPECT_FALSE(defined(192, 160));
  EXPECT_FALSE(defined(184, 192));
}

struct PairFunction {
  const char* name;
  std::function<void(const Image&, const Image&)> call;
};

void PrintTo(const PairFunction& function, std::ostream* stream) { *stream << function.name; }

class EveryMetric : public testing::TestWithParam<PairFunction> {
 protected:
  static void expectError(const Image& reference, const Image& test, const std::string& part) {
    EXPECT_THAT([&] { GetParam().call(reference, test); }, throwsInputError(HasSubstr(part)));
  }
};

TEST_P(EveryMetric, RefusesUnequalAndEmptyImages) {
  expectError(Image(16, 16), Image(16, 17), "16x17");
  expectError(Image(17, 16), Image(16, 16), "17x16");
  expectError(Image(), Image(), "at least one pixel");
}

TEST_P(EveryMetric, NamesImageAndPlaceOfNanAndInfinity) {
  const Image good(192, 192, glm::vec3(0.5f));
  Image bad = good;
  bad(12, 34).y = kNan;
  bad(13, 35).z = kInfinity;
  expectError(bad, good, "x = 12, y = 34 of the reference image");
  expectError(good, bad, "x = 12, y = 34 of the test image");
  bad(12, 34).y = -kInfinity;
  expectError(good, bad, "x = 12, y = 34 of the test image");
}

TEST_P(EveryMetric, TakesOnePixel) { EXPECT_NO_THROW(GetParam().call(Image(1, 1), Image(1, 1, glm::vec3(1.0f)))); }

const PairFunction kFunctions[] = {
    {"ErrorSums", [](const Image& r, const Image& t) { computeErrorSums(r, t); }},
    {"Ssim", [](const Image& r, const Image& t) { computeSsim(r, t); }},
    {"MsSsim", [](const Image& r, const Image& t) { computeMsSsim(r, t); }},
    {"FlipLdr", [](const Image& r, const Image& t) { computeFlipLdr(r, t); }},
    {"FlipHdr", [](const Image& r, const Image& t) { computeFlipHdr(r, t); }},
    {"All", [](const Image& r, const Image& t) { computeMetrics({.reference = r, .test = t}); }},
    {"Prepared", [](const Image& r, const Image& t) { MetricsReference(r).compare(t); }},
};
INSTANTIATE_TEST_SUITE_P(All, EveryMetric, testing::ValuesIn(kFunctions), testing::PrintToStringParamName());

// Equality of every number and map of two results.
void expectSameBits(const MetricsResult& a, const MetricsResult& b) {
  const auto expectSameMetrics = [](const Metrics& p, const Metrics& q) {
    for (const MetricInfo& metric : metricTable()) EXPECT_EQ(metric.value(p), metric.value(q)) << metric.key;
    EXPECT_EQ(p.flipLdr.weightedMedian, q.flipLdr.weightedMedian);
  };
  expectSameMetrics(a.whole, b.whole);
  ASSERT_EQ(a.masked.has_value(), b.masked.has_value());
  if (a.masked) expectSameMetrics(*a.masked, *b.masked);
  EXPECT_EQ(a.flipLdrMap, b.flipLdrMap);
  EXPECT_EQ(a.flipHdrMap, b.flipHdrMap);
}

// Several bands of rows, a width that no vector length divides, and a mask.
class ManyBands : public testing::Test {
 protected:
  ManyBands() {
    for (int i = 0; i < 100; ++i) mask_(i, i + 20) = 1;
  }
  MetricsResult metrics() const {
    return computeMetrics({.reference = reference_, .test = test_, .exposure = -1}, &mask_);
  }

  Image reference_ = noiseImage(203, 150, 1, 5.0f), test_ = noiseImage(203, 150, 2, 5.0f);
  Mask mask_{203, 150};
};

TEST_F(ManyBands, AnyNumberOfThreadsGivesTheSameBits) {
  const auto withThreads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return metrics();
  };
  const MetricsResult one = withThreads(1);
  expectSameBits(one, withThreads(2));
  expectSameBits(one, withThreads(5));
}

TEST_F(ManyBands, PreparedReferenceGivesTheSameBits) {
  const MetricsReference prepared(reference_, {.exposure = -1});
  expectSameBits(prepared.compare(test_, &mask_), metrics());
  expectSameBits(prepared.compare(test_, &mask_), metrics());
}

TEST_F(ManyBands, ExposureAppliesToLdrFlipPsnrAndSsimOnly) {
  const Metrics exposed = metrics().whole;
  const Metrics plain = computeMetrics({.reference = reference_, .test = test_}).whole;
  const Metrics halved = computeMetrics({.reference = scaled(reference_, 0.5f), .test = scaled(test_, 0.5f)}).whole;
  EXPECT_EQ(exposed.flipLdr.mean, halved.flipLdr.mean);
  EXPECT_EQ(exposed.sums.psnr, halved.sums.psnr);
  EXPECT_EQ(exposed.ssim->mean, halved.ssim->mean);
  EXPECT_EQ(exposed.sums.mse, plain.sums.mse);
  EXPECT_EQ(exposed.flipHdr->mean, plain.flipHdr->mean);
  EXPECT_NE(exposed.sums.psnr, plain.sums.psnr);
}

TEST_F(ManyBands, ClampForDisplayAppliesToPsnrAndSsimOnly) {
  const auto clamped = [](Image image) {
    for (glm::vec3& pixel : image) pixel = glm::clamp(pixel, 0.0f, 1.0f);
    return image;
  };
  const Metrics display = computeMetrics({.reference = reference_, .test = test_, .clampForDisplay = true}).whole;
  const Metrics plain = computeMetrics({.reference = reference_, .test = test_}).whole;
  const Metrics wanted = computeMetrics({.reference = clamped(reference_), .test = clamped(test_)}).whole;
  EXPECT_EQ(display.sums.psnr, wanted.sums.psnr);
  EXPECT_EQ(display.ssim->luma, wanted.ssim->luma);
  EXPECT_EQ(display.sums.mse, plain.sums.mse);
  EXPECT_EQ(display.flipLdr.mean, plain.flipLdr.mean);
  EXPECT_NE(display.sums.psnr, plain.sums.psnr);
}

TEST_F(ManyBands, MaskedMetricsAreThoseOfTheMapsOverTheMask) {
  const MetricsResult result = metrics();
  ASSERT_TRUE(result.masked);
  EXPECT_EQ(result.masked->sums.mse, computeErrorSums(reference_, test_, &mask_).mse);
  EXPECT_EQ(result.masked->flipLdr.mean, poolFlip(result.flipLdrMap, &mask_).mean);
  EXPECT_EQ(result.masked->flipHdr->mean, poolFlip(result.flipHdrMap, &mask_).mean);
  EXPECT_EQ(result.masked->ssim->mean, computeSsim(scaled(reference_, 0.5f), scaled(test_, 0.5f), &mask_)->mean);
  EXPECT_NE(result.masked->flipHdr->mean, result.whole.flipHdr->mean);
  EXPECT_FALSE(result.masked->msSsim);
}

TEST(Metrics, OverEmptyMask_AreAbsent) {
  const Image image = noiseImage(20, 20, 1);
  const Mask empty(20, 20), otherSize(20, 19);
  EXPECT_FALSE(computeMetrics({.reference = image, .test = image}, &empty).masked);
  EXPECT_FALSE(computeMetrics({.reference = image, .test = image}).masked);
  EXPECT_THAT([&] { computeMetrics({.reference = image, .test = image}, &otherSize); },
              throwsInputError(HasSubstr("20x19")));
}

TEST(Metrics, OfSrgbValues_IgnoreExposure) {
  const Image a = noiseImage(20, 20, 1), b = noiseImage(20, 20, 2);
  const Metrics plain = computeMetrics({.reference = a, .test = b, .srgb = true}).whole;
  const Metrics exposed = computeMetrics({.reference = a, .test = b, .srgb = true, .exposure = 3}).whole;
  EXPECT_EQ(plain.flipLdr.mean, exposed.flipLdr.mean);
  EXPECT_EQ(plain.sums.psnr, exposed.sums.psnr);
}

TEST(MetricTable, HoldsEveryMetricInOrder) {
  std::vector<std::string> keys;
  for (const MetricInfo& metric : metricTable()) keys.push_back(metric.key);
  EXPECT_THAT(keys, testing::ElementsAre("bias", "mse", "rmse", "mae", "max_abs", "psnr", "relmse", "smape", "ssim",
                                         "ssim_luma", "ms_ssim", "flip_ldr", "flip_hdr"));
}

TEST(MetricTable, ReadsEachMetricFromItsOwnMember) {
  Metrics metrics;
  metrics.sums = {.bias = 0, .mse = 1, .rmse = 2, .mae = 3, .maxAbs = 4, .psnr = 5, .relmse = 6, .smape = 7};
  metrics.ssim = Ssim{.mean = 8, .luma = 9};
  metrics.msSsim = 10;
  metrics.flipLdr.mean = 11;
  metrics.flipHdr = FlipPooled{.mean = 12};
  double expected = 0;
  for (const MetricInfo& metric : metricTable()) EXPECT_EQ(metric.value(metrics), expected++) << metric.key;
}

TEST(MetricTable, LowerIsBetterTellsWhichWayAnErrorMovesAValue) {
  const Image image = noiseImage(176, 176, 1);
  Image near = image, far = image;
  for (glm::vec3& pixel : near) pixel += 0.01f;
  for (glm::vec3& pixel : far) pixel += 0.2f;
  const Metrics good = computeMetrics({.reference = image, .test = near}).whole;
  const Metrics bad = computeMetrics({.reference = image, .test = far}).whole;
  for (const MetricInfo& metric : metricTable()) {
    EXPECT_EQ(metric.value(good).value() < metric.value(bad).value(), metric.lowerIsBetter) << metric.key;
  }
}

}  // namespace
}  // namespace pb::test
