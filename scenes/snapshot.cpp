#include "scenes/snapshot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <map>

#include "scenes/camera_path.h"
#include "scenes/deformation.h"
#include "scenes/error.h"
#include "scenes/luminance.h"
#include "scenes/scene_pose.h"
#include "scenes/screen.h"
#include "scenes/spec.h"

namespace pb {
namespace {

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

}  // namespace

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

}  // namespace pb
