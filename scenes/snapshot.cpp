#include "scenes/snapshot.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <type_traits>

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

struct Pose {
  glm::vec3 translation;
  glm::quat rotation;
  glm::vec3 scale;
};

glm::mat4 localMatrix(const Node& node, const Pose& pose) {
  if (node.matrix) return *node.matrix;
  const glm::mat4 rotation = glm::mat4_cast(glm::normalize(pose.rotation));
  return glm::scale(glm::translate(glm::mat4(1.0f), pose.translation) * rotation, pose.scale);
}

std::vector<glm::mat4> worldMatrices(const Scene& scene, double timeSeconds) {
  std::vector<Pose> poses;
  poses.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) poses.push_back({node.translation, node.rotation, node.scale});
  for (const Track& track : scene.tracks) {
    const glm::vec4 value = sampleTrack(track, timeSeconds);
    Pose& pose = poses[static_cast<std::size_t>(track.node)];
    switch (track.target) {
      case TrackTarget::translation:
        pose.translation = glm::vec3(value);
        break;
      case TrackTarget::scale:
        pose.scale = glm::vec3(value);
        break;
      case TrackTarget::rotation:
        pose.rotation = glm::quat(value.w, value.x, value.y, value.z);
        break;
    }
  }
  std::vector<glm::mat4> world(scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const int parent = scene.nodes[n].parent;
    const glm::mat4 local = localMatrix(scene.nodes[n], poses[n]);
    world[n] = parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local;
  }
  return world;
}

// Inverse transpose up to a positive factor: the matrix of cofactors, which exists for singular matrices too.
glm::mat3 normalMatrixOf(const glm::mat3& m) {
  const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  return glm::determinant(m) < 0.0f ? -cofactors : cofactors;
}

shading::Light worldLight(const PunctualLight& light, const glm::mat4& world) {
  shading::Light result;
  result.positionKind = glm::vec4(glm::vec3(world[3]), light.kind);
  result.directionRange = glm::vec4(shading::safeNormalize(-glm::vec3(world[2])), light.range);
  result.intensity = glm::vec4(light.intensity, 0.0f);
  // KHR_lights_punctual: the falloff as a linear function of the cosine.
  const float scale = 1.0f / std::max(1e-3f, std::cos(light.innerConeAngle) - std::cos(light.outerConeAngle));
  result.cone = {scale, -std::cos(light.outerConeAngle) * scale, 0.0f, 0.0f};
  return result;
}

shading::View cameraView(const Camera& camera, const glm::mat4& world, double aspect) {
  const float tangent = std::tan(0.5f * camera.verticalFov);
  // Scale and shear of the node do not belong to a camera (glTF 2.0, 3.10.2): rebuilt from its -Z and +Y.
  const glm::vec3 forward = shading::safeNormalize(-glm::vec3(world[2]));
  const glm::vec3 right = shading::safeNormalize(glm::cross(forward, glm::vec3(world[1])));
  const glm::vec3 up = glm::cross(right, forward);
  shading::View view;
  view.origin = glm::vec4(glm::vec3(world[3]), camera.zNear);
  view.forward = glm::vec4(forward, 0.0f);
  view.right = glm::vec4(tangent * static_cast<float>(aspect) * right, 0.0f);
  view.down = glm::vec4(-tangent * up, 0.0f);
  return view;
}

// One probe a node: all its specular-dominant instances share it.
void addProbes(Snapshot& snapshot, const std::vector<glm::mat4>& world) {
  std::map<int, int> probeOfNode;
  std::vector<Bounds> bounds;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    SnapshotInstance& instance = snapshot.instances[i];
    const int node = snapshot.scene->instances[i].node;
    const std::optional<ProbeSettings>& settings = snapshot.scene->nodes[static_cast<std::size_t>(node)].probe;
    if (!snapshot.materialOf(instance).isSpecularDominant() || (settings && !settings->enabled)) continue;
    const auto [found, isNew] = probeOfNode.try_emplace(node, static_cast<int>(snapshot.probes.size()));
    if (isNew) {
      snapshot.probes.push_back({glm::vec3(0.0f), {}, snapshot.scene->probeNear});
      bounds.emplace_back();
    }
    instance.probe = found->second;
    snapshot.probes[static_cast<std::size_t>(found->second)].owners.push_back(static_cast<int>(i));
    bounds[static_cast<std::size_t>(found->second)].include(instance.worldBounds);
  }
  for (const auto& [node, probe] : probeOfNode) {
    const std::optional<ProbeSettings>& settings = snapshot.scene->nodes[static_cast<std::size_t>(node)].probe;
    snapshot.probes[static_cast<std::size_t>(probe)].position =
        settings && settings->position
            ? glm::vec3(world[static_cast<std::size_t>(node)] * glm::vec4(*settings->position, 1.0f))
            : bounds[static_cast<std::size_t>(probe)].centre();
  }
}

const Camera& findCamera(const Scene& scene, const std::string& name) {
  if (name.empty()) return scene.cameras.front();
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throwInputError("scene '{}': camera {}", scene.name, unknownMessage(name, names));
}

// Feeds plain values to one streaming hash.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState()) { XXH3_64bits_reset(state_); }
  ~Hasher() { XXH3_freeState(state_); }
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  void bytes(const void* data, std::size_t size) { XXH3_64bits_update(state_, data, size); }
  template <class T>
  void value(const T& v) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T> || std::is_class_v<T>);
    bytes(&v, sizeof v);
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_); }

 private:
  XXH3_state_t* state_;
};

void hashTexture(Hasher& hasher, const Scene& scene, int texture) {
  hasher.value(texture);
  if (texture < 0) return;
  const ImageRgba& level0 = scene.textures[static_cast<std::size_t>(texture)].levels.front();  // determines the others
  hasher.value(level0.width());
  hasher.value(level0.height());
  hasher.bytes(level0.data(), level0.size() * sizeof(glm::vec4));
}

void hashMaterial(Hasher& hasher, const Scene& scene, const Material& m) {
  hasher.value(m.constants);
  for (const int texture :
       {m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture, m.emissionTexture, m.occlusionTexture})
    hashTexture(hasher, scene, texture);
  hasher.value(m.doubleSided);
  hasher.value(m.specularFactor);
  hasher.value(m.specularColor);
  hasher.value(m.thickness);
  hasher.value(m.attenuationDistance);
  hasher.value(m.attenuationColor);
  hasher.value(m.dispersion);
}

// Values of the slot's texture, white without one.
shading::vec4 sampleSlot(const Scene& scene, int texture, const shading::TextureSlot& slot,
                         const SurfaceAttributes& a) {
  if (texture < 0) return shading::vec4(1.0f);
  const shading::sampler2D image{&scene.textures[static_cast<std::size_t>(texture)].levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return shading::sampleTexture(image, uv, lod, slot.sampler_);
}

}  // namespace

std::vector<WorldMesh> worldMeshes(const Scene& scene, double timeSeconds) {
  const std::vector<glm::mat4> world = worldMatrices(scene, timeSeconds);
  std::vector<WorldMesh> result;
  result.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances)
    result.push_back({world[static_cast<std::size_t>(instance.node)], instance.mesh});
  return result;
}

std::shared_ptr<const Snapshot> makeSnapshot(std::shared_ptr<const Scene> scene, int frame, const std::string& camera,
                                             double aspect) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->scene = std::move(scene);
  const Scene& s = *snapshot->scene;
  const double seconds = frame / s.framesPerSecond;
  snapshot->timeSeconds = s.durationSeconds > 0.0 ? std::fmod(seconds, s.durationSeconds) : 0.0;
  const std::vector<glm::mat4> world = worldMatrices(s, snapshot->timeSeconds);
  for (const Instance& instance : s.instances) {
    const glm::mat4& matrix = world[static_cast<std::size_t>(instance.node)];
    const float determinant = glm::determinant(glm::mat3(matrix));
    SnapshotInstance result;
    result.mesh = instance.mesh;
    result.material = instance.material;
    result.worldFromObject = matrix;
    result.normalMatrix = normalMatrixOf(glm::mat3(matrix));
    result.uvScale = 1.0f / std::cbrt(std::max(std::abs(determinant), 1e-12f));
    result.mirrored = determinant < 0.0f;
    result.worldBounds = transformed(instance.mesh->bounds, matrix);
    snapshot->instances.push_back(result);
  }
  for (const PunctualLight& light : s.lights)
    snapshot->lights.push_back(worldLight(light, world[static_cast<std::size_t>(light.node)]));
  addProbes(*snapshot, world);
  const Camera& chosen = findCamera(s, camera);
  snapshot->camera = cameraView(chosen, world[static_cast<std::size_t>(chosen.node)], aspect);
  return snapshot;
}

std::uint64_t contentHash(const Snapshot& snapshot) {
  Hasher hasher;
  const Scene& scene = *snapshot.scene;
  for (const SnapshotInstance& instance : snapshot.instances) {
    hasher.value(instance.mesh->contentHash);
    hasher.value(instance.worldFromObject);
    hasher.value(instance.material);
    hasher.value(instance.probe);
  }
  for (const Material& material : scene.materials) hashMaterial(hasher, scene, material);
  for (const shading::Light& light : snapshot.lights) hasher.value(light);
  hasher.value(scene.environment.sky);
  hasher.value(scene.environment.ambient);
  for (const ImageRgba& face : scene.environment.faces) hasher.bytes(face.data(), face.size() * sizeof(glm::vec4));
  for (const Probe& probe : snapshot.probes) {
    hasher.value(probe.position);
    hasher.value(probe.zNear);
  }
  hasher.value(snapshot.camera);
  return hasher.digest();
}

shading::View withResolution(shading::View view, int widthPx) {
  view.forward.w = 2.0f * glm::length(glm::vec3(view.right)) / static_cast<float>(widthPx);
  return view;
}

shading::View cubeFaceView(glm::vec3 position, int face, float zNear) {
  shading::View view;
  view.origin = glm::vec4(position, zNear);
  view.forward = glm::vec4(shading::cubeFaceForward(face), 0.0f);
  view.right = glm::vec4(shading::cubeFaceRight(face), 0.0f);
  view.down = glm::vec4(shading::cubeFaceDown(face), 0.0f);
  return view;
}

shading::Surface readSurface(const Scene& scene, const Material& material, const SurfaceAttributes& a) {
  const shading::MaterialConstants& c = material.constants;
  shading::vec3 normal = a.normal;
  if (material.normalTexture >= 0 && a.tangent.w != 0.0f)
    normal = shading::mappedNormal(a.normal, a.tangent, sampleSlot(scene, material.normalTexture, c.normalSlot, a),
                                   c.emission.w);
  return shading::makeSurface(c, a.position, normal, a.color,
                              sampleSlot(scene, material.baseColorTexture, c.baseColorSlot, a),
                              sampleSlot(scene, material.metallicRoughnessTexture, c.metallicRoughnessSlot, a),
                              sampleSlot(scene, material.emissionTexture, c.emissionSlot, a),
                              sampleSlot(scene, material.occlusionTexture, c.occlusionSlot, a));
}

std::uint32_t baseColorTexelId(const Scene& scene, const Material& material, const SurfaceAttributes& a) {
  if (material.baseColorTexture < 0) return 0;
  const shading::TextureSlot& slot = material.constants.baseColorSlot;
  const shading::sampler2D image{&scene.textures[static_cast<std::size_t>(material.baseColorTexture)].levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return static_cast<std::uint32_t>(shading::nearestTexelId(image, uv, lod, slot.sampler_));
}

glm::vec3 localRadiance(const Snapshot& snapshot, const shading::Surface& surface) {
  shading::vec3 irradiance(0.0f);
  for (const shading::Light& light : snapshot.lights)
    irradiance += shading::lightIrradianceOn(light, surface.position, surface.normal);
  return shading::localRadiance(surface, irradiance,
                                shading::ambientRadiance(snapshot.scene->environment.ambient, surface.normal));
}

}  // namespace pb
