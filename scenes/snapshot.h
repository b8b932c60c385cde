// A scene at one time: immutable, the only input of both renderers. Everything is in world space.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/shading/shading.h"

namespace pb {

struct SnapshotInstance {
  std::shared_ptr<const Mesh> mesh;  // of a deforming instance: its shape at this time
  int material = 0;
  glm::mat4 worldFromObject;
  glm::mat3 normalMatrix;  // inverse transpose of the upper 3x3, not normalised
  float uvScale = 1.0f;    // multiplies the mesh's uvPerMetre
  bool mirrored = false;   // the transform reverses orientation
  Bounds worldBounds;
  int probe = -1;         // index into Snapshot::probes, -1 for none
  int source = 0;         // index into Scene::instances
  int nearestProbe = -1;  // of instances without one of their own: the probe nearest to the centre of their bounds
};

// A triangle that gives light to others.
struct EmittingTriangle {
  int instance;
  std::uint32_t triangle;
};

struct Probe {
  glm::vec3 position;                // world
  std::vector<int> owners;           // instances shaded by this probe; hidden while it is captured
  float zNear;                       // near plane of its faces, metres
  std::optional<Bounds> proxyBox{};  // world: the surroundings as a box, where node or scene state one
};

struct Snapshot {
  std::shared_ptr<const Scene> scene;  // materials, textures, environments
  double timeSeconds = 0.0;
  std::size_t environmentIndex = 0;  // of the one at this time, for Scene::environmentAt()
  std::vector<SnapshotInstance> instances;
  std::vector<shading::Light> lights;
  std::vector<shading::AreaLight> areaLights;      // triangles of emissive materials, at most kMaxAreaLights
  std::vector<EmittingTriangle> areaLightSources;  // where each of them comes from
  std::vector<Texture> screens;                    // pictures of Scene::screens at this time
  std::vector<Probe> probes;
  shading::View camera;  // for the aspect given to makeSnapshot; forward.w is set by withResolution()

  const Material& materialOf(const SnapshotInstance& instance) const {
    return scene->materials[static_cast<std::size_t>(instance.material)];
  }
  const Environment& environment() const { return scene->environmentAt(environmentIndex); }
};

// Emissive instances give light to diffuse surfaces as long as they have no more triangles than this in all, the
// brightest first; those that don't fit are only seen.
inline constexpr std::size_t kMaxAreaLights = 64;

// Every instance's mesh as it is at that time, with its world transform; for bounds before there is a camera. Skinned
// meshes are in world space already. Throws an input Error naming the node if a world transform holds numbers beyond
// kLargestWorldTransform, and naming the mesh for vertices beyond it.
struct WorldMesh {
  glm::mat4 worldFromObject;
  std::shared_ptr<const Mesh> mesh;
  bool mirrored = false;  // triangles are clockwise seen from outside, by the transform or by the skin's
};
std::vector<WorldMesh> worldMeshes(const Scene& scene, double timeSeconds);

// The scene at `frame` (looped if it is animated) through the camera of that name ("" for the first) or on an orbit,
// which goes on while the scene loops (parseOrbit() in scenes/camera_path.h). aspect is width / height. Throws an input
// Error for an unknown camera and as worldMeshes() does.
std::shared_ptr<const Snapshot> makeSnapshot(std::shared_ptr<const Scene> scene, int frame, const std::string& camera,
                                             double aspect);

// Sets nearestProbe of all instances that have no probe of their own.
void findNearestProbes(Snapshot& snapshot);

// Everything that determines a picture of this snapshot: geometry, transforms, materials, textures, lights,
// environment, probes and camera. Equal hashes mean equal pictures.
std::uint64_t contentHash(const Snapshot& snapshot);

// Everything that determines a reference of this snapshot: proxy boxes, which only lookups in probes read, are left
// out.
std::uint64_t referenceHash(const Snapshot& snapshot);

// The view with its sample cone set for an image that is `widthPx` samples wide (see shading/texture.glsl, coneLod).
shading::View withResolution(shading::View view, int widthPx);

// One face of a cube at `position`: 90 degrees, rows in GL memory order (see shading/cubemap.glsl).
shading::View cubeFaceView(glm::vec3 position, int face, float zNear);

// A hit point's surface with its textures read: the C++ twin of readSurface() in raster/shaders/surface_fetch.glsl.
// uvs, colour, normal and tangent as interpolated; coneWidth in metres, cosine between ray and normal (for the LOD).
struct SurfaceAttributes {
  glm::vec3 position;
  glm::vec3 normal;   // interpolated and normalised, on the viewer's side
  glm::vec4 tangent;  // interpolated, w = 0: no tangent
  glm::vec2 uv0, uv1;
  glm::vec4 color;
  float uvPerMetre;
  float coneWidth;
  float cosine;
};
shading::Surface readSurface(const Snapshot& snapshot, const Material& material, const SurfaceAttributes& a);

// The picture that the material emits, of the screen it shows at this time if it shows one; null: emission is uniform.
const Texture* emissionTextureOf(const Snapshot& snapshot, const Material& material);

// Emitted radiance, its mean over the texture.
glm::vec3 meanEmission(const Snapshot& snapshot, const Material& material);

// SampleId::texel of the point: see nearestTexelId() in shading/texture.glsl, 0 without a base colour texture.
std::uint32_t baseColorTexelId(const Scene& scene, const Material& material, const SurfaceAttributes& a);

// Share of uniform light that the surface's dielectric coat keeps from what lies under it; 0 for surfaces without coat.
glm::vec3 coatAlbedo(const shading::Surface& surface, const glm::vec3& toViewer);

// What a surface sends to the viewer (unit direction) without reflecting or refracting other surfaces or the
// environment and without highlights: emission, lights without shadows, ambient.
glm::vec3 localRadiance(const Snapshot& snapshot, const shading::Surface& surface, const glm::vec3& toViewer);

// What a primary sample shows, for masks and for the control's left-out pixels. Instance id is index + 1, 0 the
// environment; group is the smoothing group + 1; texel identifies the base colour texel if a texture is read with a
// nearest filter, else 0.
struct SampleId {
  std::uint32_t instance = 0;
  std::uint32_t group = 0;
  std::uint32_t texel = 0;
  friend bool operator==(const SampleId&, const SampleId&) = default;
};

}  // namespace pb
