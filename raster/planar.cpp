#include "raster/planar.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "raster/culling.h"
#include "raster/lookup.h"
#include "raster/reflection.h"
#include "scenes/error.h"

namespace pb {
namespace {

// How far points of a flat reflector may lie off their plane, relative to its size, and how far its normals may point
// away from that of the plane, in radians. Reflected rays turn by twice as much: 2e-4 is a fifth of a pixel's angle in
// an image that sees 60 degrees over 1000 pixels, and rounding of transforms is a thousandth of it.
constexpr float kFlatness = kPlanarThickness;

bool isPlanar(const Technique& technique) {
  return technique.probes != ProbeUse::environmentOnly && lookupOf(technique.lookup).isPlanar;
}

std::vector<glm::vec3> worldPositions(const SnapshotInstance& instance) {
  std::vector<glm::vec3> positions;
  positions.reserve(instance.mesh->positions.size());
  for (const glm::vec3& p : instance.mesh->positions)
    positions.emplace_back(instance.worldFromObject * glm::vec4(p, 1.0f));
  return positions;
}

// Their sum over the triangles, of twice the area each.
glm::vec3 areaVector(const Mesh& mesh, const std::vector<glm::vec3>& positions) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a = positions[mesh.indices[i]];
    sum += glm::cross(glm::dvec3(positions[mesh.indices[i + 1]]) - a, glm::dvec3(positions[mesh.indices[i + 2]]) - a);
  }
  return glm::vec3(sum);
}

bool fits(const SnapshotInstance& instance, const std::vector<glm::vec3>& positions, const MirrorPlane& plane) {
  const float tolerance = kFlatness * glm::length(instance.worldBounds.extent());
  return std::ranges::all_of(positions,
                             [&](const glm::vec3& p) { return std::abs(plane.distanceTo(p)) <= tolerance; }) &&
         std::ranges::all_of(instance.mesh->normals, [&](const glm::vec3& n) {
           const glm::vec3 normal = glm::normalize(instance.normalMatrix * n);
           return glm::length(glm::cross(normal, plane.normal)) <= kFlatness && glm::dot(normal, plane.normal) > 0.0f;
         });
}

// Lets a camera behind a single-sided reflector see nothing of it.
bool isSeen(const Snapshot& snapshot, const SnapshotInstance& instance, const MirrorPlane& plane) {
  const Material& material = snapshot.materialOf(instance);
  const bool hasBack = material.doubleSided || material.constants.kind.x == shading::kSurfaceGlass;
  return (hasBack || plane.distanceTo(glm::vec3(snapshot.camera.origin)) > 0.0f) &&
         !isOutsideFrustum(instance.worldBounds, snapshot.camera);
}

bool isSame(const MirrorPlane& a, const MirrorPlane& b) { return a.normal == b.normal && a.offset == b.offset; }

}  // namespace

std::optional<MirrorPlane> planeOf(const SnapshotInstance& instance) {
  const std::vector<glm::vec3> positions = worldPositions(instance);
  const glm::vec3 area = areaVector(*instance.mesh, positions);
  if (glm::length(area) == 0.0f) return std::nullopt;
  MirrorPlane plane{glm::normalize(instance.mirrored ? -area : area), 0.0f};
  glm::dvec3 sum(0.0);
  for (const glm::vec3& p : positions) sum += p;
  plane.offset = glm::dot(plane.normal, glm::vec3(sum / static_cast<double>(positions.size())));
  return fits(instance, positions, plane) ? std::optional(plane) : std::nullopt;
}

shading::View mirrored(const shading::View& view, const MirrorPlane& plane) {
  const auto direction = [&](const glm::vec4& d) {
    return glm::vec4(glm::vec3(d) - 2.0f * glm::dot(plane.normal, glm::vec3(d)) * plane.normal, d.w);
  };
  const glm::vec3 origin(view.origin);
  return {.origin = {origin - 2.0f * plane.distanceTo(origin) * plane.normal, view.origin.w},
          .forward = direction(view.forward),
          .right = direction(view.right),
          .down = direction(view.down)};
}

std::vector<MirroredView> mirroredViews(const Technique& technique, const Snapshot& snapshot) {
  std::vector<MirroredView> views;
  if (!isPlanar(technique)) return views;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    const SnapshotInstance& instance = snapshot.instances[i];
    if (instance.probe < 0) continue;
    std::optional<MirrorPlane> plane = planeOf(instance);
    if (!plane)
      throwInputError("lookup 'planar' wants flat reflectors, '{}' is not flat",
                      snapshot.scene->instances[static_cast<std::size_t>(instance.source)].name);
    if (!isSeen(snapshot, instance, *plane)) continue;
    if (plane->distanceTo(glm::vec3(snapshot.camera.origin)) < 0.0f)
      plane = MirrorPlane{-plane->normal, -plane->offset};
    const auto found = std::ranges::find_if(views, [&](const MirroredView& v) { return isSame(v.plane, *plane); });
    if (found != views.end())
      found->instances.push_back(static_cast<int>(i));
    else
      views.push_back({*plane, mirrored(snapshot.camera, *plane), {static_cast<int>(i)}});
  }
  return views;
}

bool looksUpMaps(const Technique& technique, const Snapshot& snapshot) {
  if (!isPlanar(technique)) return true;
  int reflectors = 0;
  for (const SnapshotInstance& instance : snapshot.instances) {
    if (reflectionOf(technique, snapshot, instance).source != ReflectionSource::probe) continue;
    const bool transmits = snapshot.materialOf(instance).constants.kind.x == shading::kSurfaceGlass;
    if (instance.probe < 0 || transmits || ++reflectors > 1) return true;
  }
  return false;
}

}  // namespace pb
