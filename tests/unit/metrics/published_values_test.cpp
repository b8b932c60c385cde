// Every pair with published values, within the tolerances that stand beside them.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/metrics/images.h"

namespace pb::test {
namespace {

using nlohmann::json;

// Two pairs of other projects, under licences of their own; optional.
const std::filesystem::path kExternalPairs = std::filesystem::path(PROBEBENCH_SOURCE_DIR) / "../shared/metrics";

// Single precision against mean_f64, an independent double-precision implementation. The largest deviation measured is
// 8.5e-7 (ldr_lines at 40 pixels per degree); the original implementation, in single precision too, has 4e-5.
constexpr double kDoublePrecisionMeanTolerance = 2e-6;

struct Case {
  std::string name;
  std::filesystem::path folder;
  json pair;
  json tolerances;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

std::vector<Case> casesOf(const std::filesystem::path& folder) {
  const json file = readJson(folder / "expected.json");
  std::vector<Case> cases;
  for (const json& pair : file.at("pairs")) cases.push_back({pair.at("name"), folder, pair, file.at("tolerances")});
  return cases;
}

std::vector<Case> externalCases() {
  if (!std::filesystem::exists(kExternalPairs / "expected.json")) return {{"absent", kExternalPairs, {}, {}}};
  std::vector<Case> cases = casesOf(kExternalPairs);
  std::erase_if(cases, [](const Case& c) { return !c.name.starts_with("ext_"); });
  return cases;
}

double numberOr(const json& value, double infinity) { return value == "inf" ? infinity : value.get<double>(); }

FlipSettings flipSettings(const json& entry) {
  FlipSettings settings;
  // The published default was rounded in single precision; the exact one is FlipSettings' own.
  const double ppd = entry.at("ppd");
  if (std::abs(ppd - settings.ppd) > 1e-5) settings.ppd = ppd;
  const std::string toneMapper = entry.value("tone_mapper", "aces");
  settings.toneMapper = toneMapper == "hable"      ? ToneMapper::hable
                        : toneMapper == "reinhard" ? ToneMapper::reinhard
                                                   : ToneMapper::aces;
  const json given = entry.value("given", json::object());
  if (given.contains("start")) settings.startExposure = given["start"].get<double>();
  if (given.contains("stop")) settings.stopExposure = given["stop"].get<double>();
  if (given.contains("num")) settings.numExposures = given["num"].get<int>();
  return settings;
}

// Share of pixels that differ by more than the tolerance.
double shareBeyond(const Plane& a, const Plane& b, double tolerance) {
  std::size_t beyond = 0;
  for (std::size_t i = 0; i < a.size(); ++i) beyond += std::abs(double{a[i]} - double{b[i]}) > tolerance ? 1 : 0;
  return static_cast<double>(beyond) / static_cast<double>(a.size());
}

class PublishedValues : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (GetParam().pair.is_null()) {
      GTEST_SKIP() << "the optional pairs are not here: " << kExternalPairs.lexically_normal().string();
    }
    reference_ = readRgb(file("reference"));
    test_ = readRgb(file("test"));
  }

  const json& pair() const { return GetParam().pair; }
  double tolerance(const char* name) const { return GetParam().tolerances.at(name); }
  std::filesystem::path file(const char* key) const { return GetParam().folder / pair().at(key).get<std::string>(); }
  bool srgb() const { return pair().at("encoding") == "srgb"; }

  MetricsResult metrics(const json& flipEntry) const {
    return computeMetrics({.reference = reference_, .test = test_, .srgb = srgb(), .flip = flipSettings(flipEntry)});
  }

  void expectPooled(const json& entry, const FlipPooled& pooled) const {
    EXPECT_NEAR(pooled.mean, entry.at("mean").get<double>(), tolerance("flip_mean"));
    EXPECT_NEAR(pooled.mean, entry.at("mean_f64").get<double>(), kDoublePrecisionMeanTolerance);
    const double percentile = tolerance("flip_percentile");
    EXPECT_NEAR(pooled.weightedQ1, entry.at("weighted_q1").get<double>(), percentile);
    EXPECT_NEAR(pooled.weightedMedian, entry.at("weighted_median").get<double>(), percentile);
    EXPECT_NEAR(pooled.weightedQ3, entry.at("weighted_q3").get<double>(), percentile);
    EXPECT_NEAR(pooled.min, entry.at("min").get<double>(), tolerance("flip_map_any_pixel"));
    EXPECT_NEAR(pooled.max, entry.at("max").get<double>(), tolerance("flip_map_any_pixel"));
  }

  void expectMap(const json& entry, const Plane& map) const {
    if (!entry.contains("map")) return;
    const auto channels = readExrChannels((GetParam().folder / entry.at("map").get<std::string>()).string());
    ASSERT_EQ(channels.size(), 1u);
    const Plane& expected = channels[0].plane;
    ASSERT_EQ(map.width(), expected.width());
    ASSERT_EQ(map.height(), expected.height());
    EXPECT_LE(shareBeyond(map, expected, tolerance("flip_map_95_percent")), 0.05);
    EXPECT_EQ(shareBeyond(map, expected, tolerance("flip_map_any_pixel")), 0.0);
  }

  Image reference_, test_;
};

TEST_P(PublishedValues, ErrorSumsAndSsimAgree) {
  const json& expected = pair().at("values");
  const Metrics metrics = this->metrics(pair().at("flip").at(0)).whole;
  for (const MetricInfo& metric : metricTable()) {
    if (!expected.contains(metric.key)) continue;
    SCOPED_TRACE(metric.key);
    const json& wanted = expected.at(metric.key);
    const std::optional<double> value = metric.value(metrics);
    ASSERT_EQ(value.has_value(), !wanted.is_null());
    if (!value) continue;
    const double number = numberOr(wanted, std::numeric_limits<double>::infinity());
    const bool isSsim = metric.key.find("ssim") != std::string::npos;
    if (std::isinf(number)) {
      EXPECT_EQ(*value, number);
    } else {
      EXPECT_NEAR(*value, number, isSsim ? tolerance("ssim") : tolerance("error_sums_relative") * std::abs(number));
    }
  }
  if (!metrics.ssim) return;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(metrics.ssim->channels[i], expected.at("ssim_channels").at(i).get<double>(), tolerance("ssim"));
  }
}

TEST_P(PublishedValues, FlipAgrees) {
  for (const json& entry : pair().at("flip")) {
    SCOPED_TRACE(entry.dump());
    const bool hdr = entry.at("mode") == "hdr";
    const MetricsResult result = metrics(entry);
    if (!hdr) {
      expectPooled(entry, result.whole.flipLdr);
      expectMap(entry, result.flipLdrMap);
      continue;
    }
    ASSERT_TRUE(result.whole.flipHdr);
    expectPooled(entry, *result.whole.flipHdr);
    expectMap(entry, result.flipHdrMap);
    EXPECT_NEAR(result.whole.startExposure, entry.at("start_exposure").get<double>(), tolerance("exposure"));
    EXPECT_NEAR(result.whole.stopExposure, entry.at("stop_exposure").get<double>(), tolerance("exposure"));
    EXPECT_EQ(result.whole.numExposures, entry.at("num_exposures").get<int>());
  }
}

TEST_P(PublishedValues, EightBitPairsHaveNoHdrFlip) {
  const MetricsResult result = metrics(pair().at("flip").at(0));
  EXPECT_EQ(result.whole.flipHdr.has_value(), !srgb());
  EXPECT_EQ(result.flipHdrMap.empty(), srgb());
}

INSTANTIATE_TEST_SUITE_P(Synthetic, PublishedValues, testing::ValuesIn(casesOf(kPairs)),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(External, PublishedValues, testing::ValuesIn(externalCases()),
                         testing::PrintToStringParamName());

TEST(ColorMaps, MagmaOfPublishedMap_IsPublishedPicture) {
  const auto channels = readExrChannels((kPairs / "maps/ldr_gradient_shift.flip_ldr.exr").string());
  const Image expected = readRgb(kPairs / "maps/ldr_gradient_shift.flip_ldr.magma.png");
  const Image colors = magma(channels.at(0).plane);
  ASSERT_EQ(colors.size(), expected.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      const float byte = std::floor(255.0f * colors[i][channel] + 0.5f);
      ASSERT_EQ(byte, std::round(255.0f * expected[i][channel])) << "pixel " << i;
    }
  }
}

struct NamedColorMap {
  const char* name;
  Image (*colors)(const Plane&);
};

void PrintTo(const NamedColorMap& colorMap, std::ostream* stream) { *stream << colorMap.name; }

class ColorMap : public testing::TestWithParam<NamedColorMap> {};

TEST_P(ColorMap, ShowsItsTableFrom0To1) {
  Plane ramp(256, 1);
  for (int i = 0; i < 256; ++i) ramp(i, 0) = static_cast<float>(i) / 255.0f;
  const Image colors = GetParam().colors(ramp);
  std::ifstream table(kPairs / (std::string(GetParam().name) + ".csv"));
  char comma = 0;
  for (const glm::vec3& color : colors) {
    glm::vec3 row(-1);
    table >> row.x >> comma >> row.y >> comma >> row.z;
    ASSERT_EQ(color, row);
  }
}

TEST_P(ColorMap, OutOfRangeValuesTakeTheEnds) {
  Plane map(4, 1);
  map(0, 0) = -1.0f;
  map(1, 0) = 0.0f;
  map(2, 0) = 1.0f;
  map(3, 0) = 2.0f;
  const Image colors = GetParam().colors(map);
  EXPECT_EQ(colors(0, 0), colors(1, 0));
  EXPECT_EQ(colors(2, 0), colors(3, 0));
  EXPECT_NE(colors(1, 0), colors(2, 0));
}

INSTANTIATE_TEST_SUITE_P(All, ColorMap,
                         testing::Values(NamedColorMap{"magma", magma}, NamedColorMap{"viridis", viridis}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace pb::test
