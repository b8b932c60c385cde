// The steps of FLIP against the numbers of its papers and of an independent double-precision computation.
#include "bench/metrics/fast_math.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "bench/metrics/flip_color.h"
#include "bench/metrics/flip_kernels.h"
#include "bench/metrics/tone_mapping.h"
#include "tests/unit/metrics/images.h"

namespace pb::flip {
namespace {

constexpr double kDefaultPpd = FlipSettings{}.ppd;

// Largest error of f over [first, last], at 200 values per octave.
double largestError(float first, float last, const std::function<double(float)>& error) {
  double largest = 0;
  for (double x = double{first}; x <= double{last}; x *= std::exp2(1.0 / 200)) {
    largest = std::max(largest, std::abs(error(static_cast<float>(x))));
  }
  return largest;
}

TEST(FastMath, Log2_KeepsItsErrorBound) {
  const auto error = [](float x) {
    const double exact = std::log2(double{x});
    return (double{fastLog2(x)} - exact) / std::max(1.0, std::abs(exact));
  };
  EXPECT_LT(largestError(1e-37f, 1e37f, error), 3e-7);
  EXPECT_EQ(fastLog2(1.0f), 0.0f);
}

TEST(FastMath, Exp2_KeepsItsErrorBound) {
  for (double x = -126; x <= 127; x += 0.0137) {
    const double exact = std::exp2(double{static_cast<float>(x)});
    ASSERT_NEAR(double{fastExp2(static_cast<float>(x))} / exact, 1.0, 2e-7) << x;
  }
  EXPECT_EQ(fastExp2(0.0f), 1.0f);
}

TEST(FastMath, Cbrt_KeepsItsErrorBound) {
  const auto error = [](float x) { return double{fastCbrt(x)} / std::cbrt(double{x}) - 1.0; };
  EXPECT_LT(largestError(1e-37f, 1e37f, error), 1e-7);
}

struct ColorCase {
  const char* name;
  Triple rgb, ycxcz, lab, hunt;
};

void PrintTo(const ColorCase& c, std::ostream* stream) { *stream << c.name; }

class FlipColor : public testing::TestWithParam<ColorCase> {};

// 500 times the rounding of a cube root near 1 is 3e-5; the largest deviation measured is 4e-5.
constexpr float kColorTolerance = 1e-4f;

void expectNear(const Triple& value, const Triple& expected) {
  EXPECT_NEAR(value.v0, expected.v0, kColorTolerance);
  EXPECT_NEAR(value.v1, expected.v1, kColorTolerance);
  EXPECT_NEAR(value.v2, expected.v2, kColorTolerance);
}

TEST_P(FlipColor, OpponentSpace_IsScaledYCxCz) {
  const Triple opponent = opponentFromLinear(GetParam().rgb);
  expectNear({116 * opponent.v0 - 16, 500 * opponent.v1, 200 * opponent.v2}, GetParam().ycxcz);
}

Triple labFromLinear(const Triple& rgb) { return labFromXyz(clampedXyzFromOpponent(opponentFromLinear(rgb))); }

TEST_P(FlipColor, LabAndHuntAdjustment_MatchPublishedValues) {
  const Triple lab = labFromLinear(GetParam().rgb);
  expectNear(lab, GetParam().lab);
  expectNear(huntAdjusted(lab), GetParam().hunt);
}

INSTANTIATE_TEST_SUITE_P(All, FlipColor,
                         testing::Values(ColorCase{"SkyBlue",
                                                   {0.25f, 0.5f, 0.75f},
                                                   {37.926758f, -12.947066f, -49.774308f},
                                                   {73.861452f, -7.329309f, -23.803080f},
                                                   {73.861452f, -5.413534f, -17.581300f}},
                                         ColorCase{"Green",
                                                   {0, 1, 0},
                                                   {66.961226f, -169.470305f, 121.143471f},
                                                   {87.736211f, -86.178705f, 83.182566f},
                                                   {87.736211f, -75.609930f, 72.981231f}},
                                         ColorCase{"Blue",
                                                   {0, 0, 1},
                                                   {-7.627097f, 58.841021f, -160.120350f},
                                                   {32.298170f, 79.193598f, -107.858637f},
                                                   {32.298170f, 25.578083f, -34.836366f}},
                                         ColorCase{"White", {1, 1, 1}, {100, 0, 0}, {100, 0, 0}, {100, 0, 0}},
                                         ColorCase{"NearBlack",
                                                   {0.001f, 0.002f, 0.0005f},
                                                   {-15.805225f, -0.198891f, 0.201204f},
                                                   {1.516718f, -1.548770f, 1.566780f},
                                                   {1.516718f, -0.023490f, 0.023764f}}),
                         testing::PrintToStringParamName());

TEST(FlipColorClamp, OfColorsOutsideOfTheGamut_IsThatOfClampedRgb) {
  expectNear(labFromLinear({-0.2f, 0.5f, 1.7f}), labFromLinear({0.0f, 0.5f, 1.0f}));
  expectNear(labFromLinear({3.0f, 2.0f, 1.5f}), labFromLinear({1.0f, 1.0f, 1.0f}));
  expectNear(labFromLinear({-1.0f, -2.0f, -3.0f}), labFromLinear({0.0f, 0.0f, 0.0f}));
}

TEST(FlipColorDistance, OfGreenAndBlue_IsTheLargest) {
  const auto adjusted = [](const Triple& rgb) { return huntAdjusted(labFromLinear(rgb)); };
  EXPECT_NEAR(hyab(adjusted({0, 1, 0}), adjusted({0, 0, 1})), 203.301655f, kColorTolerance);
}

struct KernelCase {
  const char* label;
  KernelName name;
  std::vector<double> weights;  // from offset 0, at the default number of pixels per degree
};

void PrintTo(const KernelCase& c, std::ostream* stream) { *stream << c.label; }

class FlipKernel : public testing::TestWithParam<KernelCase> {
 protected:
  // Weight at an offset of the whole kernel; those that the half does not hold follow from its symmetry.
  static double weightAt(const Kernel& kernel, int offset) {
    const int index = offset - kernel.firstOffset;
    if (kernel.symmetry == Symmetry::curvature && offset == 0) return -2.0 * sumOfHalf(kernel);
    if (index < 0 || index >= static_cast<int>(kernel.weights.size())) return 0;
    const double weight = double{kernel.weights[static_cast<std::size_t>(index)]};
    return kernel.symmetry == Symmetry::even && offset == 0 ? 2 * weight : weight;
  }

  static double sumOfHalf(const Kernel& kernel) {
    double sum = 0;
    for (const float weight : kernel.weights) sum += double{weight};
    return sum;
  }
};

TEST_P(FlipKernel, AtDefaultPpd_MatchesPublishedWeights) {
  const Kernels kernels = makeKernels(kDefaultPpd);
  const Kernel& kernel = kernels[GetParam().name];
  // Weights below 1e-8 are left out; published ones are rounded to 9 decimals, ours to floats below 0.5. The centre of
  // the curvature kernel is a sum of 9 such floats.
  const double tolerance = kernel.symmetry == Symmetry::curvature ? 2e-7 : 2.5e-8;
  for (std::size_t i = 0; i < GetParam().weights.size(); ++i) {
    EXPECT_NEAR(weightAt(kernel, static_cast<int>(i)), GetParam().weights[i], tolerance) << "offset " << i;
  }
  EXPECT_LE(kernel.radius(), static_cast<int>(GetParam().weights.size()) - 1);
}

INSTANTIATE_TEST_SUITE_P(
    All, FlipKernel,
    testing::Values(KernelCase{"Achromatic",
                               kAchromatic,
                               {0.385760197, 0.241703701, 0.059453984, 0.005741302, 0.000217656, 0.000003239,
                                0.000000019, 0, 0, 0, 0}},
                    KernelCase{"RedGreen",
                               kRedGreen,
                               {0.363269060, 0.239982343, 0.069188184, 0.008705352, 0.000478016, 0.000011455,
                                0.000000120, 0.000000001, 0, 0, 0}},
                    KernelCase{"BlueYellow1",
                               kBlueYellow1,
                               {0.115442052, 0.109271658, 0.092669753, 0.070413424, 0.047935792, 0.029238247,
                                0.015978269, 0.007823393, 0.003432002, 0.001348922, 0.000475021}},
                    KernelCase{"BlueYellow2",
                               kBlueYellow2,
                               {0.081692790, 0.074819244, 0.057478057, 0.037038212, 0.020019679, 0.009076604,
                                0.003451826, 0.001101117, 0.000294630, 0.000066127, 0.000012449}},
                    KernelCase{"Smooth",
                               kSmooth,
                               {0.145257466, 0.135950170, 0.111456043, 0.080040550, 0.050349955, 0.027744103,
                                0.013391366, 0.005661893, 0.002096916, 0.000680272}},
                    KernelCase{"Edge",
                               kEdge,
                               {0, -0.125649028, -0.206021713, -0.221927284, -0.186139463, -0.128209460, -0.074260094,
                                -0.036630179, -0.015504234, -0.005658545}},
                    KernelCase{"Point",
                               kPoint,
                               {-0.298901543, -0.242699895, -0.107849334, 0.032054028, 0.117550389, 0.133767891,
                                0.105268697, 0.064845736, 0.032707098, 0.013806161}}),
    testing::PrintToStringParamName());

struct RadiusCase {
  double ppd;
  int color, feature;
};

void PrintTo(const RadiusCase& c, std::ostream* stream) { *stream << "Ppd" << static_cast<int>(c.ppd); }

class FlipKernelRadius : public testing::TestWithParam<RadiusCase> {};

TEST_P(FlipKernelRadius, MatchesPublishedRadius) {
  const Kernels kernels = makeKernels(GetParam().ppd);
  EXPECT_EQ(kernels[kBlueYellow1].radius(), GetParam().color);
  EXPECT_EQ(kernels[kEdge].radius(), GetParam().feature);
  EXPECT_EQ(kernels.radius, std::max(GetParam().color, GetParam().feature));
}

INSTANTIATE_TEST_SUITE_P(All, FlipKernelRadius,
                         testing::Values(RadiusCase{20, 3, 3}, RadiusCase{30, 5, 4}, RadiusCase{40, 6, 5},
                                         RadiusCase{kDefaultPpd, 10, 9}, RadiusCase{90, 13, 12},
                                         RadiusCase{110, 15, 14}, RadiusCase{120, 17, 15}),
                         testing::PrintToStringParamName());

struct ToneCase {
  const char* name;
  ToneMapper toneMapper;
  double at018, at1, at4;  // curve at grey inputs
  double inverse085;
};

void PrintTo(const ToneCase& c, std::ostream* stream) { *stream << c.name; }

class FlipToneCurve : public testing::TestWithParam<ToneCase> {};

TEST_P(FlipToneCurve, AndItsInverse_MatchPublishedValues) {
  const RationalCurve c = toneCurve(GetParam().toneMapper);
  const auto at = [&](double x) { return (c.k0 * x * x + c.k1 * x + c.k2) / (c.k3 * x * x + c.k4 * x + c.k5); };
  EXPECT_NEAR(at(0.18), GetParam().at018, 1e-9);
  EXPECT_NEAR(at(1), GetParam().at1, 1e-9);
  EXPECT_NEAR(at(4), GetParam().at4, 1e-9);
  EXPECT_NEAR(inverseToneCurve(c, 0.85), GetParam().inverse085, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    All, FlipToneCurve,
    testing::Values(ToneCase{"Aces", ToneMapper::aces, 0.140119567, 0.673290473, 0.934211203, 2.118872324},
                    ToneCase{"Hable", ToneMapper::hable, 0.128339362, 0.492919679, 0.918031235, 3.127749278},
                    ToneCase{"Reinhard", ToneMapper::reinhard, 0.152542373, 0.5, 0.8, 5.666666667}),
    testing::PrintToStringParamName());

// A row of greys of the given luminances; the luminance weights sum to 1.
Image greys(const std::vector<float>& luminances) {
  Image image(static_cast<int>(luminances.size()), 1);
  std::transform(luminances.begin(), luminances.end(), image.begin(), [](float l) { return glm::vec3(l); });
  return image;
}

constexpr double kAcesTarget = 2.118872324;

TEST(FlipExposures, ComeFromLargestAndUpperMedianLuminance) {
  const ExposureRange range = chooseExposures(greys({0.5f, 64, 1, 2}), {});
  EXPECT_NEAR(range.start, std::log2(kAcesTarget / 64), 1e-6);
  EXPECT_NEAR(range.stop, std::log2(kAcesTarget / 2), 1e-6);
  EXPECT_EQ(range.count, 5);
  EXPECT_NEAR(range[0], range.start, 1e-12);
  EXPECT_NEAR(range[4], range.stop, 1e-12);
}

TEST(FlipExposures, OfConstantImage_AreTwoEqualOnes) {
  const ExposureRange range = chooseExposures(greys({3, 3, 3}), {});
  EXPECT_EQ(range.start, range.stop);
  EXPECT_EQ(range.count, 2);
}

TEST(FlipExposures, WhereMedianIsBlack_UseMedianOfPositiveLuminances) {
  const ExposureRange range = chooseExposures(greys({0, 0, 0, 0, 0, 8, 1, 4}), {});
  EXPECT_NEAR(range.start, std::log2(kAcesTarget / 8), 1e-6);
  EXPECT_NEAR(range.stop, std::log2(kAcesTarget / 4), 1e-6);
}

TEST(FlipExposures, CountNegativeLuminancesAsBlack) {
  const ExposureRange negative = chooseExposures(greys({-5, 1, 2, -1, 4}), {});
  const ExposureRange black = chooseExposures(greys({0, 1, 2, 0, 4}), {});
  EXPECT_EQ(negative.start, black.start);
  EXPECT_EQ(negative.stop, black.stop);
}

TEST(FlipExposures, OfBlackReference_AreZeroOrTheGivenOne) {
  const Image black = greys({0, 0, 0});
  const ExposureRange automatic = chooseExposures(black, {});
  EXPECT_EQ(automatic.start, 0);
  EXPECT_EQ(automatic.stop, 0);
  EXPECT_EQ(automatic.count, 2);
  EXPECT_EQ(chooseExposures(black, {.startExposure = -3.0}).stop, -3);
  EXPECT_EQ(chooseExposures(black, {.stopExposure = 2.0}).start, 2);
}

TEST(FlipExposures, AreClampedForExtremeLuminances) {
  const ExposureRange range = chooseExposures(greys({1e-44f, 1e-44f, 3e38f}), {});
  EXPECT_EQ(range.start, -120);
  EXPECT_EQ(range.stop, 120);
  EXPECT_EQ(range.count, 240);
}

TEST(FlipExposures, GivenOnesReplaceAutomaticOnes) {
  const Image image = greys({1, 2, 64});
  const ExposureRange automatic = chooseExposures(image, {});
  const ExposureRange range = chooseExposures(image, {.stopExposure = 4.0, .numExposures = 3});
  EXPECT_EQ(range.start, automatic.start);
  EXPECT_EQ(range.stop, 4);
  EXPECT_EQ(range.count, 3);
}

TEST(FlipExposures, OutsideOfTheirRange_AreInputErrors) {
  const Image image = greys({1});
  const double nan = std::nan("");
  for (const FlipSettings& settings :
       {FlipSettings{.startExposure = -121.0}, FlipSettings{.stopExposure = 121.0}, FlipSettings{.stopExposure = nan},
        FlipSettings{.startExposure = 2.0, .stopExposure = 1.0}, FlipSettings{.numExposures = 0},
        FlipSettings{.numExposures = 1001}}) {
    EXPECT_THAT([&] { chooseExposures(image, settings); }, test::throwsInputError(testing::HasSubstr("FLIP")));
  }
  EXPECT_NO_THROW(chooseExposures(image, {.startExposure = 1.0, .stopExposure = 1.0, .numExposures = 1}));
}

}  // namespace
}  // namespace pb::flip
