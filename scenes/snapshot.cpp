#include "scenes/snapshot.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <type_traits>

#include "scenes/camera_path.h"
#include "scenes/deformation.h"
#include "scenes/dfg_table.h"
#include "scenes/error.h"
#include "scenes/luminance.h"
#include "scenes/screen.h"
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

// The scales of a chain of nodes multiply, also beyond what float holds.
void checkWorldMatrix(const Scene& scene, const Node& node, const glm::mat4& world, double timeSeconds) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      if (const float number = world[column][row]; !(std::abs(number) <= kLargestWorldTransform))
        throwInputError("world transforms hold numbers up to {:g}, that of node '{}' of scene '{}' has {:g} at {:g} s",
                        kLargestWorldTransform, node.name, scene.name, number, timeSeconds);
}

// The nodes at one time.
struct ScenePose {
  std::vector<glm::mat4> world;
  std::vector<std::vector<float>> morphWeights;
};

std::vector<glm::mat4> worldMatrices(const Scene& scene, double timeSeconds) {
  std::vector<Pose> poses;
  poses.reserve(scene.nodes.size());
  for (const Node& node : scene.nodes) poses.push_back({node.translation, node.rotation, node.scale});
  for (const Track& track : scene.tracks) {
    if (track.target == TrackTarget::morphWeights) continue;
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
      case TrackTarget::morphWeights:
        break;
    }
  }
  std::vector<glm::mat4> world(scene.nodes.size());
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const int parent = scene.nodes[n].parent;
    const glm::mat4 local = localMatrix(scene.nodes[n], poses[n]);
    world[n] = parent < 0 ? local : world[static_cast<std::size_t>(parent)] * local;
    checkWorldMatrix(scene, scene.nodes[n], world[n], timeSeconds);
  }
  return world;
}

ScenePose poseOf(const Scene& scene, double timeSeconds) {
  ScenePose pose{worldMatrices(scene, timeSeconds), {}};
  for (const Node& node : scene.nodes) pose.morphWeights.push_back(node.morphWeights);
  for (const Track& track : scene.tracks)
    if (track.target == TrackTarget::morphWeights)
      pose.morphWeights[static_cast<std::size_t>(track.node)] = sampleWeights(track, timeSeconds);
  return pose;
}

std::vector<glm::mat4> jointMatrices(const Skin& skin, const ScenePose& pose) {
  std::vector<glm::mat4> matrices;
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    matrices.push_back(pose.world[static_cast<std::size_t>(skin.joints[j])] * skin.inverseBindMatrices[j]);
  return matrices;
}

WorldMesh worldMesh(const Scene& scene, const Instance& instance, const ScenePose& pose, double timeSeconds) {
  const auto n = static_cast<std::size_t>(instance.node);
  const Node& node = scene.nodes[n];
  const Mesh& mesh = *instance.mesh;
  WorldMesh result{pose.world[n], instance.mesh, false};
  if (deforms(scene, instance)) {
    MeshPose meshPose{.morphWeights = {}, .wave = node.wave, .timeSeconds = timeSeconds, .jointMatrices = {}};
    if (!mesh.targets.empty()) meshPose.morphWeights = pose.morphWeights[n];
    if (node.skin >= 0 && !mesh.joints.empty()) {
      meshPose.jointMatrices = jointMatrices(scene.skins[static_cast<std::size_t>(node.skin)], pose);
      result.worldFromObject = glm::mat4(1.0f);
      // A skin that mirrors does so as a whole.
      result.mirrored = glm::determinant(glm::mat3(meshPose.jointMatrices.front())) < 0.0f;
    }
    result.mesh = deform(mesh, meshPose);
  }
  if (glm::determinant(glm::mat3(result.worldFromObject)) < 0.0f) result.mirrored = !result.mirrored;
  return result;
}

std::vector<WorldMesh> worldMeshes(const Scene& scene, const ScenePose& pose, double timeSeconds) {
  std::vector<WorldMesh> result;
  result.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) result.push_back(worldMesh(scene, instance, pose, timeSeconds));
  return result;
}

SnapshotInstance snapshotInstance(const WorldMesh& placed, const Instance& instance, int source) {
  const glm::mat4& matrix = placed.worldFromObject;
  SnapshotInstance result;
  result.source = source;
  result.mesh = placed.mesh;
  result.material = instance.material;
  result.worldFromObject = matrix;
  result.normalMatrix = normalMatrixOf(glm::mat3(matrix));
  result.uvScale = 1.0f / std::cbrt(std::max(std::abs(glm::determinant(glm::mat3(matrix))), 1e-12f));
  result.mirrored = placed.mirrored;
  result.worldBounds = transformed(placed.mesh->bounds, matrix);
  return result;
}

std::size_t environmentIndexAt(const Scene& scene, double timeSeconds) {
  const auto next =
      std::ranges::upper_bound(scene.environmentChanges, timeSeconds, {}, &EnvironmentChange::timeSeconds);
  return static_cast<std::size_t>(next - scene.environmentChanges.begin());
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

shading::View cameraView(float verticalFov, float zNear, const glm::mat4& world, double aspect) {
  const float tangent = std::tan(0.5f * verticalFov);
  // Scale and shear of the node do not belong to a camera (glTF 2.0, 3.10.2): rebuilt from its -Z and +Y.
  const glm::vec3 forward = shading::safeNormalize(-glm::vec3(world[2]));
  const glm::vec3 right = shading::safeNormalize(glm::cross(forward, glm::vec3(world[1])));
  const glm::vec3 up = glm::cross(right, forward);
  shading::View view;
  view.origin = glm::vec4(glm::vec3(world[3]), zNear);
  view.forward = glm::vec4(forward, 0.0f);
  view.right = glm::vec4(tangent * static_cast<float>(aspect) * right, 0.0f);
  view.down = glm::vec4(-tangent * up, 0.0f);
  return view;
}

const Texture* textureAt(const Scene& scene, int texture) {
  return texture < 0 ? nullptr : &scene.textures[static_cast<std::size_t>(texture)];
}

// One probe a node: all its instances that own one share it.
void addProbes(Snapshot& snapshot, const std::vector<glm::mat4>& world) {
  std::map<int, int> probeOfNode;
  std::vector<Bounds> bounds;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    SnapshotInstance& instance = snapshot.instances[i];
    const int node = snapshot.scene->instances[i].node;
    if (!ownsProbe(*snapshot.scene, snapshot.scene->instances[i])) continue;
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
    Probe& placed = snapshot.probes[static_cast<std::size_t>(probe)];
    placed.proxyBox = settings && settings->box ? settings->box : snapshot.scene->room;
    placed.position = settings && settings->position
                          ? glm::vec3(world[static_cast<std::size_t>(node)] * glm::vec4(*settings->position, 1.0f))
                          : bounds[static_cast<std::size_t>(probe)].centre();
  }
}

void addAreaLightsOf(Snapshot& snapshot, std::size_t index, const glm::vec3& radiance) {
  const SnapshotInstance& instance = snapshot.instances[index];
  const Mesh& mesh = *instance.mesh;
  const bool bothSides = snapshot.materialOf(instance).doubleSided;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
    std::array<glm::vec4, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = glm::vec4(
          glm::vec3(instance.worldFromObject * glm::vec4(mesh.positions[mesh.indices[3 * t + k]], 1.0f)), 0.0f);
    if (instance.mirrored) std::swap(corners[1], corners[2]);
    corners[0].w = bothSides ? 1.0f : 0.0f;
    snapshot.areaLights.push_back({corners[0], corners[1], corners[2], glm::vec4(radiance, 0.0f)});
    snapshot.areaLightSources.push_back({static_cast<int>(index), static_cast<std::uint32_t>(t)});
  }
}

// Brightest instances first, as long as all of their triangles fit.
void addAreaLights(Snapshot& snapshot) {
  struct Emitter {
    std::size_t instance;
    glm::vec3 radiance;
  };
  std::vector<Emitter> emitters;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    const Material& material = snapshot.materialOf(snapshot.instances[i]);
    const glm::vec3 radiance = meanEmission(snapshot, material);
    if (material.constants.kind.x != shading::kSurfaceUnlit && luminance(radiance) > 0.0f)
      emitters.push_back({i, radiance});
  }
  std::ranges::stable_sort(emitters, std::greater(), [](const Emitter& e) { return luminance(e.radiance); });
  for (const Emitter& e : emitters)
    if (snapshot.areaLights.size() + snapshot.instances[e.instance].mesh->triangleCount() <= kMaxAreaLights)
      addAreaLightsOf(snapshot, e.instance, e.radiance);
}

const Camera* findCamera(const Scene& scene, const std::string& name) {
  if (name.empty()) return &scene.cameras.front();
  const auto found = std::ranges::find(scene.cameras, name, &Camera::name);
  return found == scene.cameras.end() ? nullptr : &*found;
}

[[noreturn]] void refuseCamera(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  names.emplace_back("orbit");
  throwInputError("scene '{}': camera {}", scene.name, unknownMessage(name, names));
}

Bounds boundsAtStart(const Scene& scene) {
  Bounds bounds;
  for (const WorldMesh& m : worldMeshes(scene, 0.0)) bounds.include(transformed(m.mesh->bounds, m.worldFromObject));
  return bounds;
}

shading::View orbitView(const Orbit& orbit, double seconds, double aspect) {
  const CameraPose pose = poseAt(orbit, seconds);
  const glm::mat4 world = glm::translate(glm::mat4(1.0f), pose.eye) * glm::mat4_cast(pose.rotation);
  // Reversed float depth loses nothing by a near plane that is near.
  const float zNear = 1e-3f * glm::length(glm::vec2(orbit.radius, orbit.height));
  return cameraView(orbit.verticalFov, zNear, world, aspect);
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

void hashTexels(Hasher& hasher, const Texture& texture) {
  const ImageRgba& level0 = texture.levels.front();  // determines the others
  hasher.value(level0.width());
  hasher.value(level0.height());
  hasher.bytes(level0.data(), level0.size() * sizeof(glm::vec4));
}

void hashTexture(Hasher& hasher, const Scene& scene, int texture) {
  hasher.value(texture);
  if (texture >= 0) hashTexels(hasher, scene.textures[static_cast<std::size_t>(texture)]);
}

void hashMaterial(Hasher& hasher, const Scene& scene, const Material& m) {
  hasher.value(m.constants);
  for (const int texture :
       {m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture, m.emissionTexture, m.occlusionTexture})
    hashTexture(hasher, scene, texture);
  hasher.value(m.screen);
  hasher.value(m.doubleSided);
  hasher.value(m.isSpecularDominant);
}

void hashSurfacesAndLight(Hasher& hasher, const Snapshot& snapshot) {
  const Scene& scene = *snapshot.scene;
  for (const SnapshotInstance& instance : snapshot.instances) {
    hasher.value(instance.mesh->contentHash);
    hasher.value(instance.worldFromObject);
    hasher.value(instance.material);
    hasher.value(instance.probe);
  }
  for (const Material& material : scene.materials) hashMaterial(hasher, scene, material);
  for (const shading::Light& light : snapshot.lights) hasher.value(light);
  for (const Texture& screen : snapshot.screens) hashTexels(hasher, screen);
  hasher.value(scene.castsShadows);
  hasher.value(snapshot.environment().sky);
  hasher.value(snapshot.environment().ambient);
  for (const ImageRgba& face : snapshot.environment().faces) hasher.bytes(face.data(), face.size() * sizeof(glm::vec4));
  for (const Probe& probe : snapshot.probes) {
    hasher.value(probe.position);
    hasher.value(probe.zNear);
  }
  hasher.value(snapshot.camera);
}

// Values of the slot's texture, white without one.
shading::vec4 sampleSlot(const Texture* texture, const shading::TextureSlot& slot, const SurfaceAttributes& a) {
  if (texture == nullptr) return shading::vec4(1.0f);
  const shading::sampler2D image{&texture->levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return shading::sampleTexture(image, uv, lod, slot.sampler_);
}

}  // namespace

std::vector<WorldMesh> worldMeshes(const Scene& scene, double timeSeconds) {
  return worldMeshes(scene, poseOf(scene, timeSeconds), timeSeconds);
}

std::shared_ptr<const Snapshot> makeSnapshot(std::shared_ptr<const Scene> scene, int frame, const std::string& camera,
                                             double aspect) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->scene = std::move(scene);
  const Scene& s = *snapshot->scene;
  const double seconds = frame / s.framesPerSecond;
  snapshot->timeSeconds = s.durationSeconds > 0.0 ? std::fmod(seconds, s.durationSeconds) : 0.0;
  snapshot->environmentIndex = environmentIndexAt(s, snapshot->timeSeconds);
  const ScenePose pose = poseOf(s, snapshot->timeSeconds);
  const std::vector<glm::mat4>& world = pose.world;
  const std::vector<WorldMesh> meshes = worldMeshes(s, pose, snapshot->timeSeconds);
  for (std::size_t i = 0; i < meshes.size(); ++i)
    snapshot->instances.push_back(snapshotInstance(meshes[i], s.instances[i], static_cast<int>(i)));
  for (const PunctualLight& light : s.lights)
    snapshot->lights.push_back(worldLight(light, world[static_cast<std::size_t>(light.node)]));
  for (const Screen& screen : s.screens) snapshot->screens.push_back(renderScreen(screen, snapshot->timeSeconds));
  addProbes(*snapshot, world);
  findNearestProbes(*snapshot);
  addAreaLights(*snapshot);
  if (const Camera* chosen = findCamera(s, camera))
    snapshot->camera =
        cameraView(chosen->verticalFov, chosen->zNear, world[static_cast<std::size_t>(chosen->node)], aspect);
  else if (const std::optional<Orbit> orbit = parseOrbit(camera, boundsAtStart(s)))
    snapshot->camera = orbitView(*orbit, seconds, aspect);
  else
    refuseCamera(s, camera);
  return snapshot;
}

void findNearestProbes(Snapshot& snapshot) {
  for (SnapshotInstance& instance : snapshot.instances) {
    if (instance.probe >= 0 || snapshot.probes.empty()) continue;
    const auto distance = [&](const Probe& p) { return glm::distance(p.position, instance.worldBounds.centre()); };
    instance.nearestProbe =
        static_cast<int>(std::ranges::min_element(snapshot.probes, {}, distance) - snapshot.probes.begin());
  }
}

std::uint64_t contentHash(const Snapshot& snapshot) {
  Hasher hasher;
  hashSurfacesAndLight(hasher, snapshot);
  for (const Probe& probe : snapshot.probes)
    if (probe.proxyBox) hasher.value(*probe.proxyBox);
  return hasher.digest();
}

std::uint64_t referenceHash(const Snapshot& snapshot) {
  Hasher hasher;
  hashSurfacesAndLight(hasher, snapshot);
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

shading::Surface readSurface(const Snapshot& snapshot, const Material& material, const SurfaceAttributes& a) {
  const Scene& scene = *snapshot.scene;
  const shading::MaterialConstants& c = material.constants;
  shading::vec3 normal = a.normal;
  if (material.normalTexture >= 0 && a.tangent.w != 0.0f)
    normal = shading::mappedNormal(a.normal, a.tangent,
                                   sampleSlot(textureAt(scene, material.normalTexture), c.normalSlot, a), c.emission.w);
  return shading::makeSurface(
      c, a.position, normal, a.color, sampleSlot(textureAt(scene, material.baseColorTexture), c.baseColorSlot, a),
      sampleSlot(textureAt(scene, material.metallicRoughnessTexture), c.metallicRoughnessSlot, a),
      sampleSlot(emissionTextureOf(snapshot, material), c.emissionSlot, a),
      sampleSlot(textureAt(scene, material.occlusionTexture), c.occlusionSlot, a));
}

const Texture* emissionTextureOf(const Snapshot& snapshot, const Material& material) {
  if (material.screen >= 0) return &snapshot.screens[static_cast<std::size_t>(material.screen)];
  return textureAt(*snapshot.scene, material.emissionTexture);
}

glm::vec3 meanEmission(const Snapshot& snapshot, const Material& material) {
  const Texture* texture = emissionTextureOf(snapshot, material);
  const glm::vec3 factor(material.constants.emission);
  // A texture's last level is one texel, its mean.
  return texture == nullptr ? factor : factor * glm::vec3(texture->levels.back()(0, 0));
}

std::uint32_t baseColorTexelId(const Scene& scene, const Material& material, const SurfaceAttributes& a) {
  if (material.baseColorTexture < 0) return 0;
  const shading::TextureSlot& slot = material.constants.baseColorSlot;
  const shading::sampler2D image{&scene.textures[static_cast<std::size_t>(material.baseColorTexture)].levels};
  const shading::vec2 uv = shading::textureCoordinates(slot.matrix, slot.offset, a.uv0, a.uv1);
  const float lod = shading::coneLod(a.coneWidth, a.cosine, a.uvPerMetre, shading::textureSize(image, 0), slot.matrix);
  return static_cast<std::uint32_t>(shading::nearestTexelId(image, uv, lod, slot.sampler_));
}

glm::vec3 coatAlbedo(const shading::Surface& surface, const glm::vec3& toViewer) {
  if (surface.kind != shading::kSurfaceGlossy && surface.kind != shading::kSurfaceGlass) return glm::vec3(0.0f);
  const shading::sampler2D table{&dfgTable(shading::kGeometrySmithCorrelated).levels};
  const float NoV = std::max(glm::dot(surface.normal, toViewer), 0.0f);
  return shading::coatAlbedo(surface, shading::surfaceDfg(surface, table, NoV));
}

glm::vec3 localRadiance(const Snapshot& snapshot, const shading::Surface& surface, const glm::vec3& toViewer) {
  glm::vec3 irradiance(0.0f);
  for (const shading::Light& light : snapshot.lights)
    irradiance += shading::lightIrradianceOn(light, surface.position, surface.normal);
  for (const shading::AreaLight& light : snapshot.areaLights)
    irradiance += shading::areaLightIrradiance(light, surface.position, surface.normal);
  return shading::localRadiance(surface, irradiance,
                                shading::ambientRadiance(snapshot.environment().ambient, surface.normal),
                                coatAlbedo(surface, toViewer));
}

}  // namespace pb
