// Triangles that no sample of a view can show, told on the CPU: those that face away, and those outside of the view's
// sides. Pure functions of a mesh, its placement and views; what is dropped is certain, so that no pixel changes.
//
// The six faces of a cube share an eye, and their sides six planes: one pass over the mesh serves all of them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "scenes/shading/shading.h"

namespace pb {

// The planes of a mesh's triangles and its vertices, in object space.
struct TrianglePlanes {
  struct Vertices {
    std::vector<float> x, y, z;
  } vertices;
  std::vector<float> x, y, z;      // unit normals, to the side from which the triangle is counter-clockwise
  std::vector<float> offset;       // dot(normal, p) of the plane's points
  std::vector<float> slenderness;  // perimeter / (2 area) in 1/m: 1 / the radius of the inscribed circle, over 2
  float reach = 0.0f;              // no coordinate of a vertex is larger

  std::size_t size() const { return x.size(); }
};
TrianglePlanes trianglePlanes(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices);

// What is drawn.
struct PlacedTriangles {
  std::span<const glm::vec3> positions;
  std::span<const std::uint32_t> indices;
  const TrianglePlanes& planes;
  const glm::mat4& worldFromObject;
  const Bounds& worldBounds;
};

// A view of so many samples. All coordinates are of the world.
struct SampledView {
  shading::View view;
  glm::vec2 samples;
  glm::vec4 clip{0.0f};  // xyz: what has dot(clip.xyz, p) + clip.w < 0 is clipped away; 0: nothing is

  friend bool operator==(const SampledView& a, const SampledView& b) {
    return a.view.origin == b.view.origin && a.view.forward == b.view.forward && a.view.right == b.view.right &&
           a.view.down == b.view.down && a.samples == b.samples && a.clip == b.clip;
  }
};

// Which sides of triangles are drawn, as seen by counter-clockwise order in object space.
enum class ShownSides { both, front, back };

// The face of a cube along the axes that a view without clipping is, GL order.
std::optional<int> cubeFaceOf(const SampledView& view);

class TriangleCuller {
 public:
  struct Range {
    std::size_t first = 0, count = 0;
  };

  // Finds what one view may show, in the ranges' element 0.
  void cull(const PlacedTriangles& object, const SampledView& view, ShownSides sides);
  // The same for all six faces of the cube that a view is a face of.
  void cullCube(const PlacedTriangles& object, const SampledView& face, ShownSides sides);

  // Of the last call: indices() of the triangles that each view may show, in the order of the mesh.
  const std::array<Range, 6>& ranges() const { return ranges_; }
  std::span<const std::uint32_t> indices() const { return {indices_.data(), used_}; }

 private:
  struct Test;

  void collect(const PlacedTriangles& object, const Test& test);
  void classifyVertices(const PlacedTriangles& object, const Test& test);
  void findHidden(const TrianglePlanes& planes, const Test& test);
  std::uint8_t classifyTriangles(const PlacedTriangles& object, const Test& test);
  void list(std::span<const std::uint32_t> indices, int view);

  std::vector<std::uint8_t> codes_;    // by vertex: bits of the planes
  std::vector<std::uint8_t> hidden_;   // by triangle: all bits if it faces away
  std::vector<std::uint8_t> visible_;  // by triangle: a bit a view
  std::vector<std::uint32_t> indices_;
  std::size_t used_ = 0;
  std::array<Range, 6> ranges_;
};

}  // namespace pb
