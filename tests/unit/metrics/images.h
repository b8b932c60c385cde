// Pictures for the tests of the metrics: made here, or read from the pairs with published values.
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/metrics/metrics.h"
#include "scenes/error.h"
#include "scenes/image.h"
#include "scenes/image_io.h"

namespace pb::test {

inline const std::filesystem::path kPairs = std::filesystem::path(PROBEBENCH_SOURCE_DIR) / "tests/data/metrics";

inline nlohmann::json readJson(const std::filesystem::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file);
}

inline Image readRgb(const std::filesystem::path& path) { return rgbOf(readImage(path.string()).pixels); }

inline Image constantImage(int width, int height, glm::vec3 value) { return {width, height, value}; }

// The same noise for the same seed on every machine: uniform in [0, scale].
inline Image noiseImage(int width, int height, std::uint32_t seed, float scale = 1.0f) {
  Image image(width, height);
  std::uint32_t state = seed * 2654435761u + 1u;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return scale * static_cast<float>(state >> 8) / 16777216.0f;
  };
  for (glm::vec3& pixel : image) {
    pixel.x = next();
    pixel.y = next();
    pixel.z = next();
  }
  return image;
}

// Matches a call that throws an input Error whose message matches.
template <class Matcher>
auto throwsInputError(Matcher message) {
  return testing::Throws<Error>(
      testing::AllOf(testing::Property(&Error::kind, Failure::input), testing::Property(&Error::what, message)));
}

inline Image scaled(Image image, float factor) {
  for (glm::vec3& pixel : image) pixel *= factor;
  return image;
}

}  // namespace pb::test
