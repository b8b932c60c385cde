#include "scenes/builtin/shapes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace pb {
namespace {

// Two triangles a quad over a grid of (columns + 1) x (rows + 1) vertices that starts at `first`.
void appendGridIndices(Mesh& mesh, std::uint32_t first, int columns, int rows, bool skipFirstRow, bool skipLastRow) {
  const auto vertex = [&](int x, int y) { return first + static_cast<std::uint32_t>(y * (columns + 1) + x); };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::uint32_t a = vertex(x + 1, y), b = vertex(x, y), c = vertex(x, y + 1), d = vertex(x + 1, y + 1);
      if (!(skipFirstRow && y == 0)) mesh.indices.insert(mesh.indices.end(), {a, b, d});
      if (!(skipLastRow && y == rows - 1)) mesh.indices.insert(mesh.indices.end(), {b, c, d});
    }
}

void appendQuad(Mesh& mesh, glm::vec3 p, glm::vec3 u, glm::vec3 v) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  // The bitangent points up in pictures, against v (glTF 2.0, 3.9.3).
  const glm::vec4 tangent(glm::normalize(u), -1.0f);
  for (const glm::vec2& st : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
    mesh.positions.push_back(p + st.x * u + st.y * v);
    mesh.normals.push_back(normal);
    mesh.tangents.push_back(tangent);
    mesh.uvs[0].push_back(st);
  }
  mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

// Cubic Bernstein polynomials and their derivatives at t.
struct Bernstein {
  std::array<double, 4> value, derivative;
};
Bernstein bernstein(double t) {
  const double s = 1.0 - t;
  return {{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t},
          {-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t}};
}

struct PatchPoint {
  glm::dvec3 position{0.0}, du{0.0}, dv{0.0};
};
PatchPoint evaluate(const BezierPatch& patch, double u, double v) {
  const Bernstein bu = bernstein(u), bv = bernstein(v);
  PatchPoint p;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const glm::dvec3 control = patch[4 * i + j];
      p.position += bv.value[i] * bu.value[j] * control;
      p.du += bv.value[i] * bu.derivative[j] * control;
      p.dv += bv.derivative[i] * bu.value[j] * control;
    }
  return p;
}

// At a pole a whole edge of control points coincides and one derivative vanishes: the normal just inside is its limit.
glm::vec3 patchNormal(const BezierPatch& patch, double u, double v) {
  const PatchPoint p = evaluate(patch, u, v);
  const glm::dvec3 normal = glm::cross(p.du, p.dv);
  if (glm::length(normal) > 1e-9) return glm::vec3(glm::normalize(normal));
  const double inward = 1e-4;
  const PatchPoint q = evaluate(patch, u + (u < 0.5 ? inward : -inward), v + (v < 0.5 ? inward : -inward));
  return glm::vec3(glm::normalize(glm::cross(q.du, q.dv)));
}

}  // namespace

Mesh makeSphereMesh(float radius, int segments, int rings) {
  Mesh mesh;
  mesh.name = "sphere";
  for (int y = 0; y <= rings; ++y)
    for (int x = 0; x <= segments; ++x) {
      const double u = static_cast<double>(x) / segments, v = static_cast<double>(y) / rings;
      const double phi = glm::two_pi<double>() * u, theta = glm::pi<double>() * v;
      const glm::dvec3 n(-std::cos(phi) * std::sin(theta), std::cos(theta), std::sin(phi) * std::sin(theta));
      mesh.positions.emplace_back(static_cast<double>(radius) * n);
      mesh.normals.emplace_back(n);
      mesh.uvs[0].emplace_back(u, 1.0 - v);
    }
  appendGridIndices(mesh, 0, segments, rings, true, true);
  return mesh;
}

Mesh makeBoxMesh(glm::vec3 edges) {
  Mesh mesh;
  mesh.name = "box";
  const glm::vec3 x(edges.x, 0, 0), y(0, edges.y, 0), z(0, 0, edges.z), low = -0.5f * edges, high = 0.5f * edges;
  appendQuad(mesh, high - y, -z, y);     // +X
  appendQuad(mesh, low, z, y);           // -X
  appendQuad(mesh, low + y + z, x, -z);  // +Y
  appendQuad(mesh, low, x, z);           // -Y
  appendQuad(mesh, low + z, x, y);       // +Z
  appendQuad(mesh, low + x, -x, y);      // -Z
  return mesh;
}

Mesh makeQuadMesh(glm::vec3 p, glm::vec3 u, glm::vec3 v) {
  Mesh mesh;
  mesh.name = "quad";
  appendQuad(mesh, p, u, v);
  return mesh;
}

Mesh makeTorusMesh(float majorRadius, float minorRadius, int segments, int sides) {
  Mesh mesh;
  mesh.name = "torus";
  for (int y = 0; y <= sides; ++y)
    for (int x = 0; x <= segments; ++x) {
      const double u = static_cast<double>(x) / segments, v = static_cast<double>(y) / sides;
      const double phi = glm::two_pi<double>() * u, theta = glm::two_pi<double>() * v;
      const glm::dvec3 outward(std::cos(phi), 0.0, -std::sin(phi));
      const glm::dvec3 n = std::cos(theta) * outward - std::sin(theta) * glm::dvec3(0, 1, 0);
      mesh.positions.emplace_back(static_cast<double>(majorRadius) * outward + static_cast<double>(minorRadius) * n);
      mesh.normals.emplace_back(n);
      mesh.uvs[0].emplace_back(4.0 * u, 1.0 - v);
    }
  appendGridIndices(mesh, 0, segments, sides, false, false);
  return mesh;
}

void appendPatch(Mesh& mesh, const BezierPatch& patch, int segments) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int y = 0; y <= segments; ++y)
    for (int x = 0; x <= segments; ++x) {
      const double u = static_cast<double>(x) / segments, v = static_cast<double>(y) / segments;
      mesh.positions.emplace_back(evaluate(patch, u, v).position);
      mesh.normals.push_back(patchNormal(patch, u, v));
      mesh.uvs[0].emplace_back(u, v);
    }
  // Columns run along u and rows along v, so that these triangles wind around -cross(du, dv); turned to agree with the
  // normals.
  const std::size_t firstIndex = mesh.indices.size();
  appendGridIndices(mesh, first, segments, segments, false, false);
  for (std::size_t i = firstIndex; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

int addInstance(Scene& scene, std::string name, std::shared_ptr<const Mesh> mesh, int material, Node node) {
  node.name = name;
  const int index = static_cast<int>(scene.nodes.size());
  scene.nodes.push_back(std::move(node));
  scene.instances.push_back({std::move(name), index, std::move(mesh), material});
  return index;
}

int addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

int addTexture(Scene& scene, Texture texture) {
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

Material makeTexturedMaterial(std::string name, int texture, glm::vec2 repeats, glm::vec3 albedo) {
  Material material = makeDiffuseMaterial(std::move(name), albedo);
  material.baseColorTexture = texture;
  material.constants.baseColorSlot.offset.w = 1.0f;
  material.constants.baseColorSlot.matrix = {repeats.x, 0.0f, 0.0f, repeats.y};
  return material;
}

glm::vec4 roundedToBytes(const glm::vec4& color) {
  const auto rounded = [](float x) { return std::round(255.0f * x) / 255.0f; };
  const auto channel = [&](float x) { return shading::srgbDecode(rounded(shading::srgbEncode(x))); };
  return {channel(color.x), channel(color.y), channel(color.z), rounded(color.w)};
}

void addCamera(Scene& scene, std::string name, glm::vec3 eye, glm::vec3 target, float verticalFovRadians, float zNear) {
  Node node;
  node.name = name;
  node.translation = eye;
  node.rotation = glm::quatLookAt(glm::normalize(target - eye), glm::vec3(0.0f, 1.0f, 0.0f));
  scene.cameras.push_back({std::move(name), static_cast<int>(scene.nodes.size()), verticalFovRadians, zNear});
  scene.nodes.push_back(std::move(node));
}

void addDirectionalLight(Scene& scene, std::string name, glm::vec3 toLight, glm::vec3 irradiance) {
  Node node;
  node.name = std::move(name);
  const glm::vec3 direction = glm::normalize(toLight);
  node.rotation = glm::quatLookAt(-direction, std::abs(direction.y) < 0.999f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1));
  PunctualLight light;
  light.node = static_cast<int>(scene.nodes.size());
  light.intensity = irradiance;
  scene.lights.push_back(light);
  scene.nodes.push_back(std::move(node));
}

}  // namespace pb
