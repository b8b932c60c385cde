// Everything that `probebench certify` checks holds on both GL backends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/certify.h"

namespace pb {
namespace {

using Parameters = std::tuple<std::size_t, GlBackend>;

class Certification : public testing::TestWithParam<Parameters> {};

TEST_P(Certification, Holds) {
  RasterDevice device(std::get<GlBackend>(GetParam()));
  const std::vector<Check> checks = certificates()[std::get<std::size_t>(GetParam())].run(device);
  EXPECT_FALSE(checks.empty());
  EXPECT_TRUE(allPassed(checks)) << toMarkdown(checks);
}

std::string nameOf(const testing::TestParamInfo<Parameters>& info) {
  std::string name = certificates()[std::get<std::size_t>(info.param)].name;
  std::ranges::replace(name, ' ', '_');
  return name + (std::get<GlBackend>(info.param) == GlBackend::osmesa ? "_osmesa" : "_egl");
}

#ifdef PROBEBENCH_OSMESA
constexpr GlBackend kBackends[] = {GlBackend::osmesa, GlBackend::egl};
#else
constexpr GlBackend kBackends[] = {GlBackend::egl};
#endif

INSTANTIATE_TEST_SUITE_P(All, Certification,
                         testing::Combine(testing::Range(std::size_t{0}, certificates().size()),
                                          testing::ValuesIn(kBackends)),
                         nameOf);

TEST(Check, PassesWithinItsToleranceOnBothSides) {
  Check check{"name", "raster", "quantity", 0.0, 1.0, 0.1};
  for (const double inside : {0.91, 1.0, 1.09}) {
    check.measured = inside;
    EXPECT_TRUE(check.passed()) << inside;
  }
  for (const double outside : {0.89, 1.11, std::nan("")}) {
    check.measured = outside;
    EXPECT_FALSE(check.passed()) << outside;
  }
}

TEST(Summary, NamesTheFirstFailedBindingCheck) {
  const Check good{"good", "raster", "error", 0.0, 0.0, 0.1};
  Check printed{"printed", "raster", "error", 1.0, 0.0, 0.1};
  printed.binding = false;
  const Check bad{"bad", "reference", "error", 0.5, 0.0, 0.1};
  EXPECT_EQ(summary({good, printed}), "passed");
  EXPECT_TRUE(allPassed({good, printed}));
  EXPECT_EQ(summary({good, printed, bad}), "bad (reference): error is 0.5, expected 0 within 0.1");
  EXPECT_FALSE(allPassed({good, bad}));
}

}  // namespace
}  // namespace pb
