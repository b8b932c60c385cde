#include "raster/gpu_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

#include "raster/inward_distance.h"
#include "raster/simplify.h"

namespace pb {
namespace {

// What the vertex shader reads (raster/shaders/scene.vert).
struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
  glm::vec4 tangent;
  glm::vec4 uv;  // both sets
  glm::vec4 color;
  float uvPerMetre;
};

struct Attribute {
  GLint components;
  std::size_t offset;
};
constexpr std::array<Attribute, 6> kAttributes = {{{3, offsetof(Vertex, position)},
                                                   {3, offsetof(Vertex, normal)},
                                                   {4, offsetof(Vertex, tangent)},
                                                   {4, offsetof(Vertex, uv)},
                                                   {4, offsetof(Vertex, color)},
                                                   {1, offsetof(Vertex, uvPerMetre)}}};

template <class T>
T valueOr(const std::vector<T>& values, std::size_t i, const T& otherwise) {
  return values.empty() ? otherwise : values[i];
}

std::vector<Vertex> interleave(const Mesh& mesh) {
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec2 uv0 = valueOr(mesh.uvs[0], i, glm::vec2(0.0f));
    const glm::vec2 uv1 = valueOr(mesh.uvs[1], i, glm::vec2(0.0f));
    vertices.push_back({.position = mesh.positions[i],
                        .normal = mesh.normals[i],
                        .tangent = valueOr(mesh.tangents, i, glm::vec4(0.0f)),
                        .uv = {uv0.x, uv0.y, uv1.x, uv1.y},
                        .color = valueOr(mesh.colors, i, glm::vec4(1.0f)),
                        .uvPerMetre = valueOr(mesh.uvPerMetre, i, 0.0f)});
  }
  return vertices;
}

void describeInwardDistances(const gl::Functions& gl, const GpuMesh& mesh, GLuint array) {
  constexpr auto kLocation = static_cast<GLuint>(kAttributes.size());
  constexpr GLuint kBinding = 1;
  gl.VertexArrayVertexBuffer(array, kBinding, mesh.inwardDistances.id(), 0, sizeof(float));
  gl.EnableVertexArrayAttrib(array, kLocation);
  gl.VertexArrayAttribFormat(array, kLocation, 1, GL_FLOAT, GL_FALSE, 0);
  gl.VertexArrayAttribBinding(array, kLocation, kBinding);
}

void describeVertices(const gl::Functions& gl, const GpuMesh& mesh, GLuint array, const gl::Buffer& indices) {
  gl.VertexArrayVertexBuffer(array, 0, mesh.vertices.id(), 0, sizeof(Vertex));
  gl.VertexArrayElementBuffer(array, indices.id());
  for (GLuint location = 0; location < kAttributes.size(); ++location) {
    const Attribute& attribute = kAttributes[location];
    gl.EnableVertexArrayAttrib(array, location);
    gl.VertexArrayAttribFormat(array, location, attribute.components, GL_FLOAT, GL_FALSE,
                               static_cast<GLuint>(attribute.offset));
    gl.VertexArrayAttribBinding(array, location, 0);
  }
}

float radiusOf(const Mesh& mesh) {
  float radius = 0.0f;
  for (const glm::vec3& p : mesh.positions) radius = std::max(radius, glm::distance(p, mesh.bounds.centre()));
  return radius;
}

}  // namespace

GpuMesh::GpuMesh(const gl::Functions& gl, std::shared_ptr<const Mesh> source_)
    : source(std::move(source_)),
      vertexArray(gl::makeVertexArray(gl)),
      vertices(gl, source->positions.size() * sizeof(Vertex)),
      indices(gl, source->indices.size() * sizeof(std::uint32_t)),
      smoothingGroups(gl, gl::bytesOf(source->smoothingGroups)),
      indexCount(static_cast<GLsizei>(source->indices.size())),
      radius(radiusOf(*source)) {
  vertices.write(0, gl::bytesOf(interleave(*source)));
  indices.write(0, gl::bytesOf(source->indices));
  describeVertices(gl, *this, vertexArray.id(), indices);
}

void GpuMesh::simplify(const gl::Functions& gl, const Mesh& rest, float share) {
  std::vector<std::uint32_t> triangles = simplifiedTriangles(rest, share);
  const auto count = static_cast<GLsizei>(triangles.size());
  GpuTriangles made{gl::makeVertexArray(gl), gl::Buffer(gl, gl::bytesOf(triangles)), count, std::move(triangles)};
  describeVertices(gl, *this, made.vertexArray.id(), made.indices);
  if (inwardDistances.id() != 0) describeInwardDistances(gl, *this, made.vertexArray.id());
  simplified.emplace(share, std::move(made));
}

void GpuMesh::addInwardDistances(const gl::Functions& gl) {
  if (inwardDistances.id() != 0) return;
  inwardDistances = gl::Buffer(gl, source->positions.size() * sizeof(float));
  inwardDistances.write(0, gl::bytesOf(pb::inwardDistances(*source)));
  describeInwardDistances(gl, *this, vertexArray.id());
  for (const auto& [share, triangles] : simplified) describeInwardDistances(gl, *this, triangles.vertexArray.id());
  if (listedVertices.id() != 0) describeInwardDistances(gl, *this, listedVertices.id());
}

void GpuMesh::addPlanes(const gl::Functions& gl, float share) {
  if (!planes.contains(share)) planes.emplace(share, trianglePlanes(source->positions, corners(share)));
  if (listedVertices.id() != 0) return;
  listedVertices = gl::makeVertexArray(gl);
  describeVertices(gl, *this, listedVertices.id(), indices);
  if (inwardDistances.id() != 0) describeInwardDistances(gl, *this, listedVertices.id());
}

void GpuMesh::show(const std::shared_ptr<const Mesh>& shape) {
  if (shape->indices != source->indices) {
    indices.write(0, gl::bytesOf(shape->indices));
    simplified.clear();
  }
  planes.clear();
  source = shape;
  radius = radiusOf(*source);
  vertices.write(0, gl::bytesOf(interleave(*source)));
  if (inwardDistances.id() != 0) inwardDistances.write(0, gl::bytesOf(pb::inwardDistances(*source)));
}

}  // namespace pb
