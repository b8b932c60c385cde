// FLIP as a whole: closed forms, symmetries, borders of its input, pooling.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/unit/metrics/images.h"

namespace pb::test {
namespace {

using testing::HasSubstr;

double meanFlipLdr(const Image& reference, const Image& test, const FlipSettings& settings = {}) {
  return poolFlip(computeFlipLdr(reference, test, settings).map).mean;
}

double meanFlipHdr(const Image& reference, const Image& test, const FlipSettings& settings = {}) {
  return poolFlip(computeFlipHdr(reference, test, settings).map).mean;
}

float largestDifference(const Plane& a, const Plane& b) {
  float largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

Image transposed(const Image& image) {
  Image result(image.height(), image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) result(y, x) = image(x, y);
  }
  return result;
}

Plane transposed(const Plane& plane) {
  Plane result(plane.height(), plane.width());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) result(y, x) = plane(x, y);
  }
  return result;
}

struct ConstantCase {
  const char* name;
  glm::vec3 reference, test;
  double flip;
};

void PrintTo(const ConstantCase& c, std::ostream* stream) { *stream << c.name; }

class FlipOfConstants : public testing::TestWithParam<ConstantCase> {};

// Constants have no features and no borders, so FLIP is the colour difference alone. 1e-5: rounding of the cube roots,
// amplified by the power 0.7 of a small distance.
TEST_P(FlipOfConstants, IsColorDifferenceAtEveryScaleAndSize) {
  for (const double ppd : {1.0, 67.0, 300.0}) {
    for (const int side : {1, 40}) {
      const Image reference = constantImage(side, side, GetParam().reference);
      const Image test = constantImage(side, side, GetParam().test);
      const FlipPooled pooled = poolFlip(computeFlipLdr(reference, test, {.ppd = ppd}).map);
      EXPECT_NEAR(pooled.min, GetParam().flip, 1e-5) << ppd << ' ' << side;
      EXPECT_NEAR(pooled.max, GetParam().flip, 1e-5) << ppd << ' ' << side;
    }
  }
}

const ConstantCase kConstants[] = {{"SmallStep", glm::vec3(0.215860500f), glm::vec3(0.246201327f), 0.127560727},
                                   {"LargeStep", glm::vec3(0.1f), glm::vec3(0.9f), 0.951366517},
                                   {"GreenAndBlue", {0, 1, 0}, {0, 0, 1}, 1.0}};
INSTANTIATE_TEST_SUITE_P(All, FlipOfConstants, testing::ValuesIn(kConstants), testing::PrintToStringParamName());

TEST(FlipLdr, OfIdenticalImages_IsZero) {
  const Image image = noiseImage(50, 40, 1);
  EXPECT_EQ(poolFlip(computeFlipLdr(image, image).map).max, 0);
}

TEST(FlipLdr, IsSymmetric) {
  const Image a = noiseImage(50, 40, 1), b = noiseImage(50, 40, 2);
  EXPECT_EQ(computeFlipLdr(a, b).map, computeFlipLdr(b, a).map);
}

// Filters along rows and columns are the same; only the order of sums differs.
TEST(FlipLdr, OfTransposedImages_IsTransposedMap) {
  const Image a = noiseImage(50, 37, 1), b = noiseImage(50, 37, 2);
  const Plane map = computeFlipLdr(a, b).map;
  EXPECT_LT(largestDifference(transposed(map), computeFlipLdr(transposed(a), transposed(b)).map), 1e-5f);
  EXPECT_GT(largestDifference(map, Plane(50, 37)), 0.1f);
}

TEST(FlipLdr, ClampsItsInputs) {
  const Image reference = noiseImage(30, 30, 1, 2.0f), test = noiseImage(30, 30, 2, 2.0f);
  const auto clamped = [](Image image) {
    for (glm::vec3& pixel : image) pixel = glm::clamp(pixel, 0.0f, 1.0f);
    return image;
  };
  EXPECT_EQ(computeFlipLdr(reference, test).map, computeFlipLdr(clamped(reference), clamped(test)).map);
}

// Rows are processed in bands of 32: a picture of many bands, with the same content at the top, gives the same rows.
TEST(FlipLdr, DoesNotShowItsBands) {
  const Image a = noiseImage(24, 150, 1), b = noiseImage(24, 150, 2);
  const Plane whole = computeFlipLdr(a, b).map;
  const int firstRow = 23;  // not a multiple of a band's rows
  const auto cropped = [&](const Image& image) {
    Image crop(image.width(), image.height() - firstRow);
    for (int y = 0; y < crop.height(); ++y) {
      for (int x = 0; x < crop.width(); ++x) crop(x, y) = image(x, y + firstRow);
    }
    return crop;
  };
  const Plane crop = computeFlipLdr(cropped(a), cropped(b)).map;
  const int filterRadius = 10;
  for (int y = filterRadius; y < crop.height(); ++y) {
    for (int x = 0; x < crop.width(); ++x) ASSERT_EQ(crop(x, y), whole(x, y + firstRow)) << x << ' ' << y;
  }
}

TEST(FlipHdr, OfIdenticalImages_IsZeroWithExposureZero) {
  const Image image = noiseImage(50, 40, 1, 100.0f);
  const FlipResult result = computeFlipHdr(image, image);
  EXPECT_EQ(poolFlip(result.map).max, 0);
  EXPECT_EQ(poolFlip(result.exposureMap).max, 0);
}

// The exposures follow the reference's brightness; powers of 2 leave only their own rounding.
TEST(FlipHdr, DoesNotDependOnCommonScale) {
  const Image a = noiseImage(50, 40, 1, 3.0f), b = noiseImage(50, 40, 2, 3.0f);
  const Plane map = computeFlipHdr(a, b).map;
  EXPECT_LT(largestDifference(map, computeFlipHdr(scaled(a, 1024.0f), scaled(b, 1024.0f)).map), 1e-5f);
  EXPECT_GT(poolFlip(map).mean, 0.1);
}

TEST(FlipHdr, IsLargestOfItsExposures) {
  const Image a = noiseImage(30, 40, 1, 3.0f), b = noiseImage(30, 40, 2, 3.0f);
  const FlipResult result = computeFlipHdr(a, b, {.startExposure = -2.0, .stopExposure = 2.0, .numExposures = 3});
  std::vector<Plane> single;
  for (const double exposure : {-2.0, 0.0, 2.0}) {
    single.push_back(
        computeFlipHdr(a, b, {.startExposure = exposure, .stopExposure = exposure, .numExposures = 1}).map);
  }
  std::array<int, 3> wins{};
  for (std::size_t i = 0; i < result.map.size(); ++i) {
    const std::array<float, 3> errors{single[0][i], single[1][i], single[2][i]};
    const auto largest = std::max_element(errors.begin(), errors.end());
    ASSERT_EQ(result.map[i], *largest);
    ASSERT_EQ(result.exposureMap[i], 0.5f * static_cast<float>(largest - errors.begin()));
    ++wins[static_cast<std::size_t>(largest - errors.begin())];
  }
  EXPECT_GT(wins[0], 0);
  EXPECT_GT(wins[2], 0);
}

// A black reference is looked at with exposure 0, where ACES shows 0.18 as 0.140119567.
TEST(FlipHdr, OfBlackReference_IsLdrFlipAtExposureZero) {
  const Image black(20, 20), grey = constantImage(20, 20, glm::vec3(0.18f));
  const double expected = meanFlipLdr(black, constantImage(20, 20, glm::vec3(0.140119567f)));
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(meanFlipHdr(black, grey), expected, 1e-6);
}

TEST(FlipHdr, WhereMedianOfReferenceIsBlack_StillSeesTheError) {
  const Image reference = readRgb(kPairs / "images/hdr_median_zero.ref.exr");
  const Image test = readRgb(kPairs / "images/hdr_median_zero.test.exr");
  const FlipResult result = computeFlipHdr(reference, test);
  EXPECT_TRUE(std::isfinite(result.stopExposure));
  EXPECT_GE(result.numExposures, 2);
  EXPECT_GT(poolFlip(result.map).mean, 0.0);
}

TEST(FlipHdr, CountsNegativeValuesAsBlack) {
  Image negative = noiseImage(30, 30, 1, 2.0f), black = negative;
  negative(7, 9) = glm::vec3(-5.0f);
  black(7, 9) = glm::vec3(0.0f);
  const Image test = noiseImage(30, 30, 2, 2.0f);
  EXPECT_EQ(computeFlipHdr(negative, test).map, computeFlipHdr(black, test).map);
  EXPECT_EQ(computeFlipHdr(test, negative).map, computeFlipHdr(test, black).map);
}

class FlipHdrToneMapper : public testing::TestWithParam<ToneMapper> {};

TEST_P(FlipHdrToneMapper, GivesValuesFrom0To1ForExtremeInputs) {
  Image reference = noiseImage(30, 30, 1), test = noiseImage(30, 30, 2);
  reference(3, 3) = glm::vec3(3e38f, 0, 1e30f);
  test(3, 3) = glm::vec3(1e-44f);
  test(20, 20) = glm::vec3(3e38f);
  const FlipPooled pooled = poolFlip(computeFlipHdr(reference, test, {.toneMapper = GetParam()}).map);
  EXPECT_GE(pooled.min, 0.0);
  EXPECT_LE(pooled.max, 1.0);
  EXPECT_GT(pooled.mean, 0.1);
}

INSTANTIATE_TEST_SUITE_P(All, FlipHdrToneMapper,
                         testing::Values(ToneMapper::aces, ToneMapper::hable, ToneMapper::reinhard));

TEST(Flip, PixelsPerDegreeOutsideOfTheirRange_AreInputErrors) {
  const Image image = noiseImage(4, 4, 1);
  for (const double ppd : {0.0, -67.0, 0.99, 1000.1, std::nan("")}) {
    EXPECT_THAT([&] { computeFlipLdr(image, image, {.ppd = ppd}); }, throwsInputError(HasSubstr("pixels per degree")));
  }
}

Plane rowOf(const std::vector<float>& values) {
  Plane plane(static_cast<int>(values.size()), 1);
  std::copy(values.begin(), values.end(), plane.begin());
  return plane;
}

// Sums 0.125, 0.375, 1.0, 2.0 of the ascending values; quarters of the total are 0.5, 1.0 (not exceeded by 1.0), 1.5.
TEST(FlipPooling, WeightedPercentiles_AreFirstValuesBeyondFractionsOfTheTotal) {
  const FlipPooled pooled = poolFlip(rowOf({1.0f, 0.125f, 0.625f, 0.25f}));
  EXPECT_EQ(pooled.mean, 0.5);
  EXPECT_EQ(pooled.weightedQ1, 0.625);
  EXPECT_EQ(pooled.weightedMedian, 1.0);
  EXPECT_EQ(pooled.weightedQ3, 1.0);
  EXPECT_EQ(pooled.min, 0.125);
  EXPECT_EQ(pooled.max, 1.0);
}

TEST(FlipPooling, OfMapInDescendingOrder_IsThatOfAscendingOrder) {
  std::vector<float> values;
  for (int i = 0; i < 5000; ++i) values.push_back(std::exp2(-static_cast<float>(i % 977) / 40.0f));
  std::sort(values.begin(), values.end());
  const FlipPooled ascending = poolFlip(rowOf(values));
  std::reverse(values.begin(), values.end());
  const FlipPooled descending = poolFlip(rowOf(values));
  EXPECT_EQ(ascending.mean, descending.mean);
  EXPECT_EQ(ascending.weightedQ1, descending.weightedQ1);
  EXPECT_EQ(ascending.weightedMedian, descending.weightedMedian);
  EXPECT_EQ(ascending.weightedQ3, descending.weightedQ3);
  EXPECT_EQ(descending.min, values.back());
  EXPECT_EQ(descending.max, values.front());
}

TEST(FlipPooling, OfZeros_IsZero) {
  const FlipPooled pooled = poolFlip(Plane(5, 4));
  EXPECT_EQ(pooled.mean, 0);
  EXPECT_EQ(pooled.weightedMedian, 0);
  EXPECT_EQ(pooled.max, 0);
}

TEST(FlipPooling, OverMask_SeesOnlyItsPixels) {
  Mask mask(4, 1);
  mask(1, 0) = 1;
  mask(3, 0) = 255;
  const FlipPooled pooled = poolFlip(rowOf({1.0f, 0.5f, 0.0f, 0.25f}), &mask);
  EXPECT_EQ(pooled.mean, 0.375);
  EXPECT_EQ(pooled.min, 0.25);
  EXPECT_EQ(pooled.max, 0.5);
}

TEST(FlipPooling, OverUnfitMask_IsInputError) {
  const Mask empty(4, 1), otherSize(1, 4, 1);
  EXPECT_THAT([&] { poolFlip(Plane(4, 1), &empty); }, throwsInputError(HasSubstr("at least one pixel")));
  EXPECT_THAT([&] { poolFlip(Plane(4, 1), &otherSize); }, throwsInputError(HasSubstr("1x4")));
}

}  // namespace
}  // namespace pb::test
