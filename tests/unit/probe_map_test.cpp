// Maps of directions: octahedra and paraboloids.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "raster/map_conversion.h"
#include "scenes/error.h"
#include "scenes/shading/shading.h"

namespace pb {
namespace shading {
#define PB_FUNC [[maybe_unused]] inline
#include "scenes/shading/probe_map.glsl"
#undef PB_FUNC
}  // namespace shading

namespace {

using glm::vec2;
using glm::vec3;

// Evenly over the sphere (Fibonacci), with the axes and directions next to the maps' edges.
std::vector<vec3> directions() {
  std::vector<vec3> result = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    const float y = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / kCount;
    const float angle = 2.39996323f * static_cast<float>(i);
    const float radius = std::sqrt(1.0f - y * y);
    result.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
    result.push_back(glm::normalize(vec3(std::cos(angle), 1e-4f * y, std::sin(angle))));
  }
  return result;
}

// Two divisions, a normalisation and sums of numbers below 2, each with an error of some 1e-7.
constexpr float kRounding = 1e-6f;

TEST(ProbeMap, OctahedraGiveEveryDirectionBack) {
  for (const vec3& d : directions()) {
    const vec2 st = shading::octahedralCoordinates(d);
    EXPECT_LE(std::max(std::abs(st.x), std::abs(st.y)), 1.0f + kRounding);
    EXPECT_LT(glm::distance(shading::octahedralDirection(st), d), kRounding) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(ProbeMap, ParaboloidsGiveEveryDirectionBackFromItsHalf) {
  for (const vec3& d : directions()) {
    const vec2 st = shading::paraboloidCoordinates(d);
    EXPECT_LE(glm::length(st), 1.0f + kRounding);
    EXPECT_LT(glm::distance(shading::paraboloidDirection(st, d.y < 0.0f ? -1.0f : 1.0f), d), kRounding);
  }
}

TEST(ProbeMap, TheMiddleLooksUp) {
  EXPECT_EQ(shading::octahedralDirection(vec2(0)), vec3(0, 1, 0));
  EXPECT_EQ(shading::octahedralDirection(vec2(1, 0)), vec3(1, 0, 0));
  EXPECT_EQ(shading::octahedralDirection(vec2(0, 1)), vec3(0, 0, 1));
  EXPECT_EQ(shading::octahedralDirection(vec2(-1, 1)), vec3(0, -1, 0));
  EXPECT_EQ(shading::paraboloidDirection(vec2(0), -1.0f), vec3(0, -1, 0));
  EXPECT_EQ(shading::paraboloidDirection(vec2(0, -1), 1.0f), vec3(0, 0, -1));
}

// The same distance outside of an edge and inside of its other half are one direction.
TEST(ProbeMap, OctahedraGoOnBeyondTheirEdges) {
  for (const float t : {-0.9f, -0.3f, 0.0f, 0.2f, 0.7f})
    for (const float e : {1e-3f, 0.05f}) {
      EXPECT_LT(glm::distance(shading::octahedralDirection({1 + e, t}), shading::octahedralDirection({1 - e, -t})),
                kRounding);
      EXPECT_LT(glm::distance(shading::octahedralDirection({t, -1 - e}), shading::octahedralDirection({-t, -1 + e})),
                kRounding);
      // And next to each other on the sphere, not only in the map.
      EXPECT_LT(glm::distance(shading::octahedralDirection({1 + e, t}), shading::octahedralDirection({1 - e, t})),
                4.0f * e);
    }
}

TEST(ProbeMap, ParaboloidsGoOnIntoTheOtherHalf) {
  const vec3 beyond = shading::paraboloidDirection({1.1f, 0.0f}, 1.0f);
  EXPECT_LT(beyond.y, 0.0f);
  EXPECT_LT(glm::distance(shading::paraboloidDirection(shading::paraboloidCoordinates(beyond), -1.0f), beyond),
            kRounding);
}

TEST(ProbeMap, BordersAreOneTexelWide) {
  EXPECT_EQ(shading::borderedTexelCentre({1, 1}, 10), vec2(-0.875f));
  EXPECT_EQ(shading::borderedTexelCentre({8, 0}, 10), vec2(0.875f, -1.125f));
  EXPECT_EQ(shading::borderedTextureCoordinates(vec2(-0.875f, 1.0f), 10), vec2(0.15f, 0.9f));
}

TEST(ProbeMap, SquaresHaveAboutAsManyTexelsAsTheCube) {
  for (const int n : {8, 64, 256, 4096})
    for (const Storage storage : {Storage::dualParaboloid, Storage::octahedral}) {
      const MapSquares squares = mapSquares(storage, n);
      const double inside = double(squares.count) * (squares.edge - 2) * (squares.edge - 2);
      EXPECT_GE(inside, 6.0 * n * n);
      // At most two texels more along each edge.
      EXPECT_LE(inside, squares.count * std::pow(std::sqrt(6.0 * n * n / squares.count) + 2.0, 2.0));
    }
}

TEST(ProbeMap, SettingsThatDontGoTogetherAreRefused) {
  Technique technique;
  technique.storage = Storage::octahedral;
  EXPECT_NO_THROW(checkMaps(technique, ProbeFilter::none));
  EXPECT_THROW(checkMaps(technique, ProbeFilter::ggxPrefiltered), Error);
  technique.mips = true;
  EXPECT_THROW(checkMaps(technique, ProbeFilter::none), Error);
  technique.mips = false;
  technique.lookup = {"single-view", {}};
  EXPECT_THROW(checkMaps(technique, ProbeFilter::none), Error);
  technique.storage = Storage::cube;
  EXPECT_NO_THROW(checkMaps(technique, ProbeFilter::none));
  technique.mips = true;
  EXPECT_THROW(checkMaps(technique, ProbeFilter::none), Error);
}

}  // namespace
}  // namespace pb
