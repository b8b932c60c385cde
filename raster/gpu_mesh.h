// A mesh's vertices and triangles on the device.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/triangle_culling.h"
#include "scenes/scene.h"

namespace pb {

// Triangles to draw, with all vertex attributes.
struct GpuTriangles {
  gl::VertexArray vertexArray;
  gl::Buffer indices;
  GLsizei indexCount;
  std::vector<std::uint32_t> corners;  // what `indices` has
};

struct GpuMesh {
  GpuMesh(const gl::Functions& gl, std::shared_ptr<const Mesh> source_);

  std::shared_ptr<const Mesh> source;  // kept, so that its address stays its own
  gl::VertexArray vertexArray;
  gl::Buffer vertices;
  gl::Buffer indices;
  gl::Buffer smoothingGroups;  // one uint a triangle
  gl::Buffer inwardDistances;  // one float a vertex, only after addInwardDistances()
  GLsizei indexCount;
  float radius;                              // metres in object space, around the middle of the mesh's bounds
  std::map<float, GpuTriangles> simplified;  // by share of the triangles, of the same vertices
  std::map<float, TrianglePlanes> planes;    // by share, 1 for all; only after addPlanes()
  gl::VertexArray listedVertices;            // the vertices for indices of another buffer, likewise

  // The share's triangles.
  std::span<const std::uint32_t> corners(float share) const {
    return share < 1.0f ? simplified.at(share).corners : source->indices;
  }

  // The vertex attribute of two-interface refraction (raster/inward_distance.h).
  void addInwardDistances(const gl::Functions& gl);
  // Adds simplifiedTriangles(). rest: a mesh of the same topology.
  void simplify(const gl::Functions& gl, const Mesh& rest, float share);
  // What dropping triangles that can't be seen takes (raster/triangle_lists.h).
  void addPlanes(const gl::Functions& gl, float share);
  // Takes another shape of the same topology.
  void show(const std::shared_ptr<const Mesh>& shape);
};

}  // namespace pb
