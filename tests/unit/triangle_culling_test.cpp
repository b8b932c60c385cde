// Dropping triangles may never change a picture: what a rasteriser at fine resolution, with its vertices snapped, shows
// of a mesh is in the lists.
#include "raster/triangle_culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>

#include "scenes/builtin/shapes.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

using glm::vec3;

// A mesh in its place, with all that PlacedTriangles refers to.
struct Object {
  std::shared_ptr<const Mesh> mesh;
  glm::mat4 worldFromObject{1.0f};
  TrianglePlanes planes;
  Bounds bounds;

  Object(Mesh shape, const glm::mat4& m)
      : mesh(finishMesh(std::move(shape))), worldFromObject(m), planes(trianglePlanes(mesh->positions, mesh->indices)) {
    for (const vec3& p : mesh->positions) bounds.include(vec3(m * glm::vec4(p, 1.0f)));
  }
  PlacedTriangles placed() const { return {mesh->positions, mesh->indices, planes, worldFromObject, bounds}; }
};

std::set<std::array<std::uint32_t, 3>> listed(const TriangleCuller& culler, std::size_t view) {
  std::set<std::array<std::uint32_t, 3>> triangles;
  const auto [first, count] = culler.ranges()[view];
  for (std::size_t i = first; i < first + count; i += 3)
    triangles.insert({culler.indices()[i], culler.indices()[i + 1], culler.indices()[i + 2]});
  return triangles;
}

// Twice the signed area, in (1/256 px)^2; positive counter-clockwise, as GL's window has it.
std::int64_t edge(const glm::i64vec2& a, const glm::i64vec2& b, const glm::i64vec2& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Whether the triangle covers a sample on the side that is shown, with vertices snapped to 1/256 px, samples on its
// edges included. Of those in front of the near plane only: others count as covering what any point of them may show.
class Rasteriser {
 public:
  Rasteriser(const Object& object, const SampledView& view, ShownSides sides) : view_(view), sides_(sides) {
    for (const vec3& p : object.mesh->positions) {
      const vec3 world(object.worldFromObject * glm::vec4(p, 1.0f));
      clip_.push_back(shading::clipFromWorldPosition(view.view, world));
    }
    const vec3 f(view.view.forward), r(view.view.right), d(view.view.down);
    isTurned_ = (glm::dot(glm::cross(r, d), f) > 0.0f) != (glm::determinant(glm::mat3(object.worldFromObject)) < 0.0f);
  }

  bool isInFront(const std::array<std::uint32_t, 3>& t) const {
    return std::ranges::all_of(t, [&](std::uint32_t i) { return clip_[i].w > view_.view.origin.w; });
  }

  bool covers(const std::array<std::uint32_t, 3>& t) const {
    std::array<glm::i64vec2, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = snapped(clip_[t[i]]);
    const std::int64_t area = edge(p[0], p[1], p[2]);
    const bool isFront = (area > 0) != isTurned_;
    if (area == 0 || (sides_ == ShownSides::front && !isFront) || (sides_ == ShownSides::back && isFront)) return false;
    if (area < 0) std::swap(p[1], p[2]);
    const auto [x0, x1] = samples(std::minmax({p[0].x, p[1].x, p[2].x}), view_.samples.x);
    const auto [y0, y1] = samples(std::minmax({p[0].y, p[1].y, p[2].y}), view_.samples.y);
    for (std::int64_t y = y0; y <= y1; ++y)
      for (std::int64_t x = x0; x <= x1; ++x) {
        const glm::i64vec2 sample(256 * x + 128, 256 * y + 128);
        if (edge(p[0], p[1], sample) >= 0 && edge(p[1], p[2], sample) >= 0 && edge(p[2], p[0], sample) >= 0)
          return true;
      }
    return false;
  }

 private:
  glm::i64vec2 snapped(const glm::vec4& clip) const {
    const auto place = [&](float c, float size) {
      return static_cast<std::int64_t>(std::lround((c / clip.w * 0.5f + 0.5f) * size * 256.0f));
    };
    return {place(clip.x, view_.samples.x), place(clip.y, view_.samples.y)};
  }

  // Those whose centres lie in a range, within the picture.
  static std::pair<std::int64_t, std::int64_t> samples(std::pair<std::int64_t, std::int64_t> range, float size) {
    const auto last = static_cast<std::int64_t>(size) - 1;
    return {std::clamp<std::int64_t>((range.first - 128) / 256, 0, last),
            std::clamp<std::int64_t>((range.second + 128) / 256, 0, last)};
  }

  SampledView view_;
  ShownSides sides_;
  std::vector<glm::vec4> clip_;
  bool isTurned_;  // clockwise is the front (frontFace() of raster/draw_binder.cpp)
};

// Returns how many triangles cover samples.
int expectAllListed(const Object& object, const SampledView& view, ShownSides sides, const TriangleCuller& culler,
                    std::size_t range) {
  const Rasteriser rasteriser(object, view, sides);
  const auto kept = listed(culler, range);
  const std::vector<std::uint32_t>& indices = object.mesh->indices;
  int covering = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const std::array<std::uint32_t, 3> t = {indices[i], indices[i + 1], indices[i + 2]};
    if (!rasteriser.isInFront(t) || !rasteriser.covers(t)) continue;
    ++covering;
    EXPECT_TRUE(kept.contains(t)) << "triangle " << i / 3 << " covers a sample and is dropped";
  }
  return covering;
}

SampledView cubeFace(vec3 position, int face, int resolution) {
  return {.view = cubeFaceView(position, face, 0.05f), .samples = glm::vec2(static_cast<float>(resolution))};
}

// Turned, moved, scaled by different factors, sheared and, every other time, mirrored.
glm::mat4 randomPlacement(std::mt19937& random) {
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  const vec3 axis(number(random), number(random), 1.1f + number(random));
  glm::mat4 m = glm::translate(glm::mat4(1.0f), 3.0f * vec3(number(random), number(random), number(random)));
  m = glm::rotate(m, 3.0f * number(random), glm::normalize(axis));
  m = glm::scale(m, vec3(1.5f + number(random), 1.5f + number(random), 1.5f + number(random)));
  glm::mat4 shear(1.0f);
  shear[1][0] = number(random);
  shear[2][1] = number(random) > 0.0f ? 0.0f : number(random);
  const float mirror = number(random) > 0.0f ? 1.0f : -1.0f;
  return glm::scale(m * shear, vec3(mirror, 1.0f, 1.0f));
}

TEST(TriangleCulling, KeepsWhatCoversASampleOfACubeFace) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  TriangleCuller culler;
  int covering = 0;
  for (int i = 0; i < 120; ++i) {
    const Object object(makeSphereMesh(0.8f, 24, 12), randomPlacement(random));
    const vec3 eye = 2.0f * vec3(number(random), number(random), number(random));  // inside of it, too
    const int resolution = std::array{16, 128, 1024}[static_cast<std::size_t>(i % 3)];
    for (const ShownSides sides : {ShownSides::front, ShownSides::back, ShownSides::both}) {
      culler.cullCube(object.placed(), cubeFace(eye, 0, resolution), sides);
      for (int face = 0; face < 6; ++face)
        covering +=
            expectAllListed(object, cubeFace(eye, face, resolution), sides, culler, static_cast<std::size_t>(face));
    }
  }
  EXPECT_GT(covering, 10000) << "too few triangles to say anything";
}

TEST(TriangleCulling, KeepsWhatCoversASampleOfACameraAndOfItsMirrorImage) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  TriangleCuller culler;
  int covering = 0;
  for (int i = 0; i < 200; ++i) {
    const Object object(makeSphereMesh(0.8f, 24, 12), randomPlacement(random));
    const vec3 forward = glm::normalize(vec3(number(random), number(random), 1.1f + number(random)));
    const vec3 right = glm::normalize(glm::cross(forward, vec3(0, 1, 0))), down = glm::cross(forward, right);
    const float mirror = i % 2 == 0 ? 0.5f : -0.5f;
    const vec3 origin = 5.0f * vec3(number(random), number(random), number(random));
    const SampledView view{.view = {{origin, 0.1f}, {forward, 0.0f}, {mirror * right, 0.0f}, {0.3f * down, 0.0f}},
                           .samples = {320, 192}};
    for (const ShownSides sides : {ShownSides::front, ShownSides::back, ShownSides::both}) {
      culler.cull(object.placed(), view, sides);
      covering += expectAllListed(object, view, sides, culler, 0);
    }
  }
  EXPECT_GT(covering, 2000) << "too few triangles to say anything";
}

// Slivers: what faces away by a hair may be turned round by snapping.
TEST(TriangleCulling, KeepsSliversThatSnappingTurnsRound) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f), height(-2e-4f, 2e-4f);  // 0.003 px
  Mesh mesh;
  for (std::uint32_t i = 0; i < 30000; ++i) {  // nearly in the plane through the eye and a row of samples
    const float x = 2.0f + number(random);
    mesh.positions.emplace_back(x, number(random), x * 3.5f / 32.0f + height(random));
    mesh.indices.push_back(i);
  }
  const Object object(std::move(mesh), glm::mat4(1.0f));
  TriangleCuller culler;
  const SampledView view = cubeFace(vec3(0.0f), 0, 64);
  culler.cullCube(object.placed(), view, ShownSides::front);
  EXPECT_GT(expectAllListed(object, view, ShownSides::front, culler, 0), 100);
}

// From 5 radii away (1 - 1/5) / 2 = 0.4 of a sphere's area is seen; margins keep a few per cent more.
TEST(TriangleCulling, DropsMoreThanHalfOfASphere) {
  const Object object(makeSphereMesh(0.8f, 64, 32), glm::translate(glm::mat4(1.0f), vec3(4, 0, 0)));
  TriangleCuller culler;
  culler.cullCube(object.placed(), cubeFace(vec3(0.0f), 0, 128), ShownSides::front);
  const double all = static_cast<double>(object.mesh->indices.size());
  EXPECT_LT(static_cast<double>(culler.ranges()[0].count), 0.5 * all);
  EXPECT_GT(static_cast<double>(culler.ranges()[0].count), 0.35 * all);
  for (std::size_t face = 1; face < 6; ++face) EXPECT_EQ(culler.ranges()[face].count, 0u);
  culler.cullCube(object.placed(), cubeFace(vec3(0.0f), 0, 128), ShownSides::both);
  EXPECT_EQ(culler.ranges()[0].count, object.mesh->indices.size());
}

TEST(TriangleCulling, MirroringTurnsNothingRound) {
  TriangleCuller culler;
  std::array<std::size_t, 2> counts{};
  for (std::size_t i = 0; i < 2; ++i) {
    const glm::mat4 moved = glm::translate(glm::mat4(1.0f), vec3(4, 0, 0));
    const Object object(makeSphereMesh(0.8f, 64, 32), glm::scale(moved, vec3(1, 1, i == 0 ? 1 : -1)));
    culler.cullCube(object.placed(), cubeFace(vec3(0.0f), 0, 128), ShownSides::front);
    counts[i] = culler.ranges()[0].count;
  }
  EXPECT_EQ(counts[0], counts[1]);
}

TEST(TriangleCulling, TellsNoSidesOfWhatIsClipped) {
  const Object object(makeSphereMesh(0.8f, 64, 32), glm::translate(glm::mat4(1.0f), vec3(4, 0, 0)));
  TriangleCuller culler;
  SampledView view = cubeFace(vec3(0.0f), 0, 128);
  view.clip = {-1, 0, 0, 4};  // through its middle
  EXPECT_FALSE(cubeFaceOf(view).has_value());
  culler.cull(object.placed(), view, ShownSides::front);
  EXPECT_EQ(culler.ranges()[0].count, object.mesh->indices.size());
  view.clip = {-1, 0, 0, 40};
  culler.cull(object.placed(), view, ShownSides::front);
  EXPECT_LT(culler.ranges()[0].count, object.mesh->indices.size() / 2);
}

TEST(TriangleCulling, KeepsTrianglesWithoutArea) {
  Object object(makeSphereMesh(0.8f, 64, 32), glm::translate(glm::mat4(1.0f), vec3(4, 0, 0)));
  const std::vector<std::uint32_t> indices = {0, 0, 0, 70, 70, 71};
  const TrianglePlanes planes = trianglePlanes(object.mesh->positions, indices);
  TriangleCuller culler;
  culler.cullCube({object.mesh->positions, indices, planes, object.worldFromObject, object.bounds},
                  cubeFace(vec3(0.0f), 0, 128), ShownSides::front);
  EXPECT_EQ(culler.ranges()[0].count, indices.size());
}

TEST(TriangleCulling, KnowsTheFacesOfACube) {
  for (int face = 0; face < 6; ++face) EXPECT_EQ(cubeFaceOf(cubeFace(vec3(1, 2, 3), face, 64)), face);
  SampledView camera = cubeFace(vec3(0.0f), 2, 64);
  camera.view.right *= 0.5f;
  EXPECT_FALSE(cubeFaceOf(camera).has_value());
}

}  // namespace
}  // namespace pb
