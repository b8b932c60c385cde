#include "reference/surface_hit.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace pb {
namespace {

// The three vertices of a hit triangle and the weights of their attributes.
struct Corners {
  std::array<std::size_t, 3> vertices;
  std::array<float, 3> weights;

  // `otherwise` where the mesh has no such attribute.
  template <class T>
  T mix(const std::vector<T>& attribute, const T& otherwise) const {
    if (attribute.empty()) return otherwise;
    return weights[0] * attribute[vertices[0]] + weights[1] * attribute[vertices[1]] +
           weights[2] * attribute[vertices[2]];
  }
};

Corners cornersOf(const Mesh& mesh, const Hit& hit) {
  const std::size_t first = std::size_t{3} * hit.triangle;
  const glm::vec2& b = hit.barycentrics;
  return {{mesh.indices[first], mesh.indices[first + 1], mesh.indices[first + 2]}, {1.0f - b.x - b.y, b.x, b.y}};
}

// A transform that mirrors turns cross(normal, tangent) round: w takes the sign.
glm::vec4 worldTangent(const SnapshotInstance& instance, const glm::vec4& tangent) {
  const glm::vec3 direction = glm::mat3(instance.worldFromObject) * glm::vec3(tangent);
  return {shading::safeNormalize(direction), instance.mirrored ? -tangent.w : tangent.w};
}

struct VisibleHit {
  Hit hit;
  SurfaceAttributes attributes;
  float lengthMetres;
};

// The nearest surface with any coverage: as ids.frag in the raster.
std::optional<VisibleHit> nearestVisible(const TracedScene& scene, const Ray& primary, float conePerMetre) {
  const glm::vec3 d = shading::safeNormalize(primary.direction);
  float lengthMetres = 0.0f;
  Ray ray = primary;
  while (const std::optional<Hit> hit = scene.intersectPrimary(ray)) {
    lengthMetres += hit->t * glm::length(ray.direction);
    const SurfaceAttributes a = interpolate(scene, *hit, d, conePerMetre * lengthMetres);
    if (readSurface(scene.snapshot, scene.materialOf(*hit), a).opacity > 0.0f) return VisibleHit{*hit, a, lengthMetres};
    ray = {offsetOrigin(scene, *hit, a.position, d), d};
  }
  return std::nullopt;
}

}  // namespace

std::vector<unsigned char> findDarkInstances(const Snapshot& snapshot) {
  std::vector<unsigned char> dark;
  for (const SnapshotInstance& instance : snapshot.instances) {
    const shading::MaterialConstants& m = snapshot.materialOf(instance).constants;
    dark.push_back(m.kind.x != shading::kSurfaceUnlit && m.alpha.x == shading::kAlphaOpaque &&
                   glm::vec3(m.emission) == glm::vec3(0.0f));
  }
  return dark;
}

SurfaceAttributes interpolate(const TracedScene& scene, const Hit& hit, const glm::vec3& d, float coneWidth) {
  const SnapshotInstance& instance = scene.instanceOf(hit);
  const Mesh& mesh = *instance.mesh;
  const Corners corners = cornersOf(mesh, hit);
  const std::array<glm::vec3, 3> p = scene.embree.triangle(hit.instance, hit.triangle);
  const auto& w = corners.weights;
  const glm::vec3 normal =
      shading::safeNormalize(instance.normalMatrix * corners.mix(mesh.normals, glm::vec3(0.0f, 0.0f, 1.0f)));

  SurfaceAttributes a;
  a.position = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
  a.normal = hit.entering ? normal : -normal;
  a.tangent =
      mesh.tangents.empty() ? glm::vec4(0.0f) : worldTangent(instance, corners.mix(mesh.tangents, glm::vec4(0.0f)));
  a.uv0 = corners.mix(mesh.uvs[0], glm::vec2(0.0f));
  a.uv1 = corners.mix(mesh.uvs[1], glm::vec2(0.0f));
  a.color = corners.mix(mesh.colors, glm::vec4(1.0f));
  a.uvPerMetre = instance.uvScale * corners.mix(mesh.uvPerMetre, 0.0f);
  a.coneWidth = coneWidth;
  a.cosine = -glm::dot(a.normal, d);
  return a;
}

shading::Surface surfaceAt(const TracedScene& scene, const Hit& hit, const glm::vec3& d, float coneWidth) {
  return readSurface(scene.snapshot, scene.materialOf(hit), interpolate(scene, hit, d, coneWidth));
}

glm::vec3 offsetOrigin(const TracedScene& scene, const Hit& hit, const glm::vec3& position,
                       const glm::vec3& direction) {
  // Interpolating a position takes five roundings of numbers as large as the largest coordinate of a vertex, and so
  // does finding the distance to a plane: 16 units in the last place are more than both.
  constexpr float kRelativeOffset = 16.0f * std::numeric_limits<float>::epsilon();
  float largest = 0.0f;
  for (const glm::vec3& p : scene.embree.triangle(hit.instance, hit.triangle)) {
    const glm::vec3 size = glm::abs(p);
    largest = std::max({largest, size.x, size.y, size.z});
  }
  const float side = glm::dot(direction, hit.geometricNormal) < 0.0f ? -1.0f : 1.0f;
  return position + side * kRelativeOffset * largest * hit.geometricNormal;
}

SampleId identify(const TracedScene& scene, const Ray& primary, float conePerMetre) {
  const std::optional<VisibleHit> visible = nearestVisible(scene, primary, conePerMetre);
  if (!visible) return {};
  const Hit& hit = visible->hit;
  return {.instance = static_cast<std::uint32_t>(hit.instance) + 1,
          .group = scene.instanceOf(hit).mesh->smoothingGroups[hit.triangle] + 1,
          .texel = baseColorTexelId(*scene.snapshot.scene, scene.materialOf(hit), visible->attributes)};
}

float distanceAlong(const TracedScene& scene, const Ray& primary, float conePerMetre) {
  const std::optional<VisibleHit> visible = nearestVisible(scene, primary, conePerMetre);
  return visible ? visible->lengthMetres / glm::length(primary.direction) : std::numeric_limits<float>::infinity();
}

}  // namespace pb
