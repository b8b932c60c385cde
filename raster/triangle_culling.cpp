#include "raster/triangle_culling.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "raster/culling.h"

namespace pb {
namespace {

using glm::dmat3;
using glm::dvec3;
using glm::vec3;

// Rounding of a vertex on its way to a view, ours and GL's, relative to the largest numbers that are added up: some ten
// operations of half a unit in the last place (6e-8) each.
constexpr float kRounding = 1e-6f;

// How far a vertex may be moved in the window, in pixels. Rasterisers snap to 1/256 (GL asks for 1/16 at least, Mesa's
// do 1/256): 1/512 along both axes, 0.0028. Nearly three times as much, which also covers terms of second order.
constexpr float kSnapPx = 1.0f / 128.0f;
// Rounding of window coordinates, relative to the size of the window.
constexpr float kWindowRounding = 1.0f / (1 << 21);

// Planes of views. A vertex has a bit a plane, set on the plane's outer side; of planes that bound some views on one
// side and others on the other, as those of cube faces do, the bit says on which side.
struct Outside {
  unsigned ifSet;    // planes outside of which vertices are whose bit is set
  unsigned ifClear;  // ... is clear
};

// The planes x = y, x = -y, x = z, x = -z, y = z, y = -z, bits 0 to 5, set where the left-hand side is less; faces in
// GL order.
constexpr std::array<Outside, 6> kCubeFaces = {{{0b001111, 0},
                                                {0, 0b001111},
                                                {0b110010, 0b000001},
                                                {0b000001, 0b110010},
                                                {0b101000, 0b010100},
                                                {0b010100, 0b101000}}};
constexpr std::array<Outside, 1> kOneView = {{{0b1111, 0}}};

// By the bits that are set of all three vertices and of any: bit v of the low byte if the triangle may show in view v,
// of the high one if it is inside of all planes of it. Both have to say so.
struct Tables {
  std::array<std::uint16_t, 64> ofAll{}, ofAny{};
};

template <std::size_t Views>
constexpr Tables makeTables(const std::array<Outside, Views>& views) {
  Tables tables;
  for (unsigned bits = 0; bits < 64; ++bits)
    for (unsigned v = 0; v < Views; ++v) {
      const unsigned seen = 1u << v, inside = 0x100u << v;
      const auto [ifSet, ifClear] = views[v];
      tables.ofAll[bits] |=
          static_cast<std::uint16_t>(((bits & ifSet) == 0 ? seen : 0) | ((~bits & ifClear) == 0 ? inside : 0));
      tables.ofAny[bits] |=
          static_cast<std::uint16_t>(((~bits & ifClear) == 0 ? seen : 0) | ((bits & ifSet) == 0 ? inside : 0));
    }
  return tables;
}
constexpr Tables kCubeTables = makeTables(kCubeFaces);
constexpr Tables kViewTables = makeTables(kOneView);

float sumOf(const vec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }
double longest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// The most that lengths grow from object to world: the root of Gershgorin's bound of the largest eigenvalue of M^T M,
// exact where axes stay perpendicular.
double largestScale(const dmat3& m) {
  const dmat3 squares = glm::transpose(m) * m;
  double largest = 0.0;
  for (int i = 0; i < 3; ++i)
    largest = std::max(largest, std::abs(squares[i].x) + std::abs(squares[i].y) + std::abs(squares[i].z));
  return std::sqrt(largest);
}

float farthestDistance(const Bounds& box, const vec3& p) {
  return glm::length(glm::max(glm::abs(box.lower - p), glm::abs(box.upper - p)));
}

// Depth along the view's axis, or that of the cube's face that shows a point: no point of the box has less.
float leastDepth(const Bounds& box, const SampledView& view, bool isCube) {
  const vec3 origin(view.view.origin), forward(view.view.forward);
  if (!isCube) {
    const vec3 nearest = glm::mix(box.upper, box.lower, glm::greaterThan(forward, vec3(0.0f)));
    return glm::dot(forward, nearest - origin);
  }
  const vec3 gap = glm::max(box.lower - origin, origin - box.upper);
  return std::max({gap.x, gap.y, gap.z});
}

bool arePerpendicular(const vec3& a, const vec3& b) {
  return std::abs(glm::dot(a, b)) <= 1e-4f * glm::length(a) * glm::length(b);
}

bool isUpright(const shading::View& view) {
  const vec3 forward(view.forward), right(view.right), down(view.down);
  return std::abs(glm::length(forward) - 1.0f) < 1e-4f && arePerpendicular(forward, right) &&
         arePerpendicular(forward, down) && arePerpendicular(right, down);
}

// Window pixels a unit of tangent, the smaller of both axes.
float pixelsPerTangent(const SampledView& view) {
  return 0.5f * std::min(view.samples.x / glm::length(vec3(view.view.right)),
                         view.samples.y / glm::length(vec3(view.view.down)));
}

bool isClippedNowhere(const Bounds& box, const glm::vec4& clip) {
  return vec3(clip) == vec3(0.0f) || isBehindPlane(box, -vec3(clip), -clip.w);
}

}  // namespace

// What a call tests.
struct TriangleCuller::Test {
  bool isCube;
  shading::View view;
  const Tables& tables;
  int views;
  bool hasSides = false;  // vertices are told from planes
  float bias = 0.0f;      // so far inside of a plane a vertex counts as outside
  // Triangles for which sign * (dot(normal, eye) - offset) is less than -(margin * slenderness + rounding) are not
  // seen where they are inside of all planes.
  bool hasFacing = false;
  vec3 eye{0.0f};  // object space
  float sign = 1.0f, margin = 0.0f, rounding = 0.0f;

  Test(const PlacedTriangles& object, const SampledView& sampled, ShownSides sides, bool isCube_);
  void testFacing(const PlacedTriangles& object, const SampledView& sampled, float error);
};

// A sample lies half a pixel, 1/width of the depth, inside of the planes: what is nearer to them than that is as good
// as outside. So planes are moved inwards by more than rounding, and vertices inside are so for certain. Those of cubes
// stay where they are, as both sides of them matter: there GL's own arithmetic is repeated, to the last bit.
TriangleCuller::Test::Test(const PlacedTriangles& object, const SampledView& sampled, ShownSides sides, bool isCube_)
    : isCube(isCube_), view(sampled.view), tables(isCube ? kCubeTables : kViewTables), views(isCube ? 6 : 1) {
  const glm::mat4& m = object.worldFromObject;
  const vec3 origin(view.origin), right(view.right), down(view.down);
  const float size = object.planes.reach * (sumOf(vec3(m[0])) + sumOf(vec3(m[1])) + sumOf(vec3(m[2]))) +
                     sumOf(vec3(m[3])) + sumOf(origin);
  const float error = kRounding * size;
  const float slope =
      sumOf(vec3(view.forward)) + std::max(sumOf(right) / glm::dot(right, right), sumOf(down) / glm::dot(down, down));
  const float depth = leastDepth(object.worldBounds, sampled, isCube);
  const float halfPixel = std::max(depth, view.origin.w) / std::max(sampled.samples.x, sampled.samples.y);
  bias = 2.0f * slope * error;
  hasSides = 2.0f * bias < halfPixel;
  if (!hasSides || sides == ShownSides::both) return;
  // What is clipped may leave pieces as thin as you like, which snapping may turn round.
  const bool isWhole = depth > view.origin.w + error && isClippedNowhere(object.worldBounds, sampled.clip);
  if (!isWhole || !(isCube || isUpright(view))) return;
  sign = sides == ShownSides::front ? 1.0f : -1.0f;
  testFacing(object, sampled, error);
}

// With a, b, c the vertices seen from the eye, in the world, w their depths and f pixels a unit of tangent: the
// triangle covers f^2 det(a, b, c) / (2 wa wb wc) pixels, with a sign that tells its side. Moving its vertices by d
// pixels changes twice that by d times its perimeter there at most, whose edges are no longer than f |a x b| / (wa wb)
// each. So the side is certain if f |det| > d (wa |b x c| + wb |c x a| + wc |a x b|); with all distances below r and
// the triangle's perimeter P, d r^2 P or more is on the right. A vertex that is e off in the world adds up to f e r P.
// det is 2 area h, h the distance of the eye from the triangle's plane: h > P / (2 area) r (d r / f + e). In object
// space det is smaller by the determinant of the transform, and P by the largest scale or less.
void TriangleCuller::Test::testFacing(const PlacedTriangles& object, const SampledView& sampled, float error) {
  const dmat3 m(glm::mat3(object.worldFromObject));
  const double volume = std::abs(glm::determinant(m));
  const dvec3 inObject = glm::inverse(m) * (dvec3(view.origin) - dvec3(object.worldFromObject[3]));
  const double farthest = farthestDistance(object.worldBounds, vec3(view.origin));
  const double px = double{kSnapPx} + double{kWindowRounding * std::max(sampled.samples.x, sampled.samples.y)};
  const double inWorld = farthest * (px * farthest / double{pixelsPerTangent(sampled)} + double{error});
  eye = vec3(inObject);
  margin = static_cast<float>(inWorld * largestScale(m) / volume);
  rounding = kRounding * (3.0f * static_cast<float>(longest(inObject)) + 3.0f * object.planes.reach);
  hasFacing = std::isfinite(margin) && std::isfinite(rounding);
}

TrianglePlanes trianglePlanes(std::span<const vec3> positions, std::span<const std::uint32_t> indices) {
  TrianglePlanes planes;
  const std::size_t count = indices.size() / 3;
  for (auto* values : {&planes.x, &planes.y, &planes.z, &planes.offset, &planes.slenderness}) values->resize(count);
  for (const vec3& p : positions) {
    planes.vertices.x.push_back(p.x);
    planes.vertices.y.push_back(p.y);
    planes.vertices.z.push_back(p.z);
    planes.reach = std::max({planes.reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  for (std::size_t t = 0; t < count; ++t) {
    const dvec3 a = positions[indices[3 * t]], b = positions[indices[3 * t + 1]], c = positions[indices[3 * t + 2]];
    const dvec3 normal = glm::cross(b - a, c - a);
    const double twiceArea = glm::length(normal);
    const double perimeter = glm::length(b - a) + glm::length(c - b) + glm::length(a - c);
    const dvec3 unit = twiceArea > 0.0 ? normal / twiceArea : dvec3(0.0);
    planes.x[t] = static_cast<float>(unit.x);
    planes.y[t] = static_cast<float>(unit.y);
    planes.z[t] = static_cast<float>(unit.z);
    planes.offset[t] = static_cast<float>(glm::dot(unit, a));
    const double slenderness = perimeter / twiceArea;
    constexpr double kMost = std::numeric_limits<float>::max();
    planes.slenderness[t] =
        slenderness < kMost ? static_cast<float>(slenderness) : std::numeric_limits<float>::infinity();
  }
  return planes;
}

std::optional<int> cubeFaceOf(const SampledView& sampled) {
  if (vec3(sampled.clip) != vec3(0.0f) || sampled.samples.x != sampled.samples.y) return std::nullopt;
  const shading::View& view = sampled.view;
  for (int face = 0; face < 6; ++face)
    if (vec3(view.forward) == shading::cubeFaceForward(face) && vec3(view.right) == shading::cubeFaceRight(face) &&
        vec3(view.down) == shading::cubeFaceDown(face))
      return face;
  return std::nullopt;
}

void TriangleCuller::cull(const PlacedTriangles& object, const SampledView& view, ShownSides sides) {
  collect(object, Test(object, view, sides, false));
}

void TriangleCuller::cullCube(const PlacedTriangles& object, const SampledView& face, ShownSides sides) {
  collect(object, Test(object, face, sides, true));
}

void TriangleCuller::collect(const PlacedTriangles& object, const Test& test) {
  const std::size_t count = object.planes.size();
  used_ = 0;
  ranges_.fill({});
  visible_.resize(count);
  hidden_.resize(count);
  std::uint8_t seen = 0xff;
  if (test.hasSides) {
    classifyVertices(object, test);
    findHidden(object.planes, test);
    seen = classifyTriangles(object, test);
  } else {
    std::ranges::fill(visible_, std::uint8_t{0xff});
  }
  for (int v = 0; v < test.views; ++v)
    if ((seen >> v & 1) != 0) list(object.indices, v);
}

// Places vertices as scene.vert does.
void TriangleCuller::classifyVertices(const PlacedTriangles& object, const Test& test) {
  const std::size_t count = object.positions.size();
  codes_.resize(count);
  const glm::mat4& m = object.worldFromObject;
  const vec3 a(m[0]), b(m[1]), c(m[2]), d(m[3]), o(test.view.origin);
  const auto classify = [&, px = object.planes.vertices.x.data(), py = object.planes.vertices.y.data(),
                         pz = object.planes.vertices.z.data(), out = codes_.data()](const auto& codeOf) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<std::uint8_t>(codeOf((a.x * px[i] + b.x * py[i]) + (c.x * pz[i] + d.x) - o.x,
                                                (a.y * px[i] + b.y * py[i]) + (c.y * pz[i] + d.y) - o.y,
                                                (a.z * px[i] + b.z * py[i]) + (c.z * pz[i] + d.z) - o.z));
  };
  if (test.isCube)
    return classify([](float x, float y, float z) {
      return (x < y ? 1 : 0) | (x < -y ? 2 : 0) | (x < z ? 4 : 0) | (x < -z ? 8 : 0) | (y < z ? 16 : 0) |
             (y < -z ? 32 : 0);
    });
  const vec3 right(test.view.right), down(test.view.down), f(test.view.forward);
  const vec3 s = right / glm::dot(right, right), t = down / glm::dot(down, down);
  classify([s, t, f, bias = test.bias](float x, float y, float z) {
    const float u = s.x * x + s.y * y + s.z * z, v = t.x * x + t.y * y + t.z * z;
    const float w = f.x * x + f.y * y + f.z * z - bias;
    return (w < u ? 1 : 0) | (w < -u ? 2 : 0) | (w < v ? 4 : 0) | (w < -v ? 8 : 0);
  });
}

void TriangleCuller::findHidden(const TrianglePlanes& planes, const Test& test) {
  if (!test.hasFacing) {
    std::ranges::fill(hidden_, std::uint8_t{0});
    return;
  }
  const std::size_t count = planes.size();
  const float *x = planes.x.data(), *y = planes.y.data(), *z = planes.z.data(), *offset = planes.offset.data(),
              *slenderness = planes.slenderness.data();
  std::uint8_t* out = hidden_.data();
  const vec3 eye = test.sign * test.eye;
  const float sign = test.sign, margin = test.margin, rounding = test.rounding;
  for (std::size_t i = 0; i < count; ++i) {
    const float height = x[i] * eye.x + y[i] * eye.y + z[i] * eye.z - sign * offset[i];
    out[i] = height < -(margin * slenderness[i] + rounding) ? 0xff : 0;
  }
}

// Returns the views that show anything.
std::uint8_t TriangleCuller::classifyTriangles(const PlacedTriangles& object, const Test& test) {
  const std::size_t count = object.planes.size();
  const std::uint32_t* corner = object.indices.data();
  const std::uint8_t *codes = codes_.data(), *hidden = hidden_.data();
  std::uint8_t* visible = visible_.data();
  const std::uint16_t *ofAll = test.tables.ofAll.data(), *ofAny = test.tables.ofAny.data();
  unsigned seen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned a = codes[corner[3 * i]], b = codes[corner[3 * i + 1]], c = codes[corner[3 * i + 2]];
    const unsigned known = unsigned{ofAll[a & b & c]} & unsigned{ofAny[a | b | c]};
    const unsigned shown = known & ~(known >> 8 & hidden[i]);
    visible[i] = static_cast<std::uint8_t>(shown);
    seen |= shown;
  }
  return static_cast<std::uint8_t>(seen);
}

void TriangleCuller::list(std::span<const std::uint32_t> indices, int view) {
  if (indices_.size() < used_ + indices.size()) indices_.resize(used_ + indices.size());
  const std::size_t count = visible_.size();
  const std::uint8_t* visible = visible_.data();
  const std::uint32_t* in = indices.data();
  std::uint32_t* out = indices_.data() + used_;
  std::size_t n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(out + n, in + 3 * i, 3 * sizeof *in);
    n += (visible[i] >> view & 1) != 0 ? 3 : 0;
  }
  ranges_[static_cast<std::size_t>(view)] = {used_, n};
  used_ += n;
}

}  // namespace pb
