#include "scenes/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <span>

#include "scenes/error.h"
#include "scenes/snapshot.h"
#include "scenes/track.h"

namespace pb {
namespace {

// Pictures are made on the CPU for every frame.
constexpr int kMaxScreenPx = 1024;

void checkNumbers(const std::string& node, std::span<const float> numbers) {
  for (const float number : numbers)
    if (!(std::abs(number) <= kLargestTransform))
      throwInputError("animation of node '{}' wants numbers from -{:g} to {:g}, got {:g}", node, kLargestTransform,
                      kLargestTransform, number);
}

// Of a track of morph weights.
void checkWeights(const Node& node, const Track& track) {
  if (node.morphWeights.empty() || weightsPerValue(track) != node.morphWeights.size())
    throwInputError("animation of node '{}' has {} morph weights for {} keys of {} morph targets", node.name,
                    track.weights.size(), track.timesSeconds.size(), node.morphWeights.size());
  checkNumbers(node.name, track.weights);
}

void checkTrack(const Scene& scene, const Track& track) {
  const bool isOfWeights = track.target == TrackTarget::morphWeights;
  const std::string& node = scene.nodes.at(static_cast<std::size_t>(track.node)).name;
  if (track.timesSeconds.empty() ||
      (!isOfWeights && track.values.size() != track.timesSeconds.size() * valuesPerKey(track)))
    throwInputError("animation of node '{}' has {} values for {} keys", node, track.values.size(),
                    track.timesSeconds.size());
  for (std::size_t k = 0; k < track.timesSeconds.size(); ++k)
    if (!std::isfinite(track.timesSeconds[k]) || (k > 0 && track.timesSeconds[k] <= track.timesSeconds[k - 1]))
      throwInputError("animation of node '{}' wants increasing key times, got {} at key {}", node,
                      track.timesSeconds[k], k);
  if (isOfWeights) return checkWeights(scene.nodes[static_cast<std::size_t>(track.node)], track);
  if (track.target == TrackTarget::rotation) return;
  for (const glm::vec4& value : track.values) checkNumbers(node, std::array{value.x, value.y, value.z});
}

void checkSkin(const Scene& scene, const Skin& skin) {
  if (skin.joints.empty() || skin.inverseBindMatrices.size() != skin.joints.size())
    throwInputError("skin '{}' wants joints and as many inverse bind matrices, got {} and {}", skin.name,
                    skin.joints.size(), skin.inverseBindMatrices.size());
  for (const int joint : skin.joints)
    if (joint < 0 || static_cast<std::size_t>(joint) >= scene.nodes.size())
      throwInputError("skin '{}' wants joints that are nodes of the scene, got node {} of {}", skin.name, joint,
                      scene.nodes.size());
}

void checkWave(const Node& node) {
  const Wave& w = *node.wave;
  const bool isFinite = std::isfinite(w.amplitude) && std::isfinite(w.skew) && std::isfinite(w.length) &&
                        std::isfinite(w.wavelength) && std::isfinite(w.periodSeconds);
  if (!isFinite || !(std::min({w.length, w.wavelength, w.periodSeconds}) > 0.0f))
    throwInputError(
        "the wave of node '{}' wants finite numbers, length, wavelength and period above 0, got amplitude {}, length "
        "{}, "
        "wavelength {}, skew {}, period {}",
        node.name, w.amplitude, w.length, w.wavelength, w.skew, w.periodSeconds);
}

// The mesh's joints and morph targets are those of the instance's node.
void checkDeformation(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = *instance.mesh;
  const Node& node = scene.nodes.at(static_cast<std::size_t>(instance.node));
  if (!mesh.targets.empty() && node.morphWeights.size() != mesh.targets.size())
    throwInputError("node '{}' has {} morph weights, its mesh '{}' has {} morph targets", node.name,
                    node.morphWeights.size(), mesh.name, mesh.targets.size());
  if (node.skin < 0 || mesh.joints.empty()) return;
  const Skin& skin = scene.skins.at(static_cast<std::size_t>(node.skin));
  for (std::size_t v = 0; v < mesh.joints.size(); ++v)
    for (int k = 0; k < 4; ++k)
      if (const std::size_t joint = mesh.joints[v][k]; joint >= skin.joints.size())
        throwInputError("mesh '{}' has a joint out of range: vertex {} wants joint {} of {} in skin '{}'", mesh.name, v,
                        joint, skin.joints.size(), skin.name);
}

void finishDeformations(Scene& scene) {
  for (const Skin& skin : scene.skins) checkSkin(scene, skin);
  for (const Instance& instance : scene.instances) {
    Node& node = scene.nodes.at(static_cast<std::size_t>(instance.node));
    if (node.morphWeights.empty()) node.morphWeights.resize(instance.mesh->targets.size(), 0.0f);
    checkDeformation(scene, instance);
  }
  for (const Node& node : scene.nodes) {
    checkNumbers(node.name, node.morphWeights);
    if (node.wave) checkWave(node);
  }
}

// Black faces are what environments without a cube map have.
void finishEnvironments(Scene& scene) {
  const auto addFaces = [](Environment& environment) {
    if (environment.faces.empty()) environment.faces.assign(6, ImageRgba(1, 1, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)));
  };
  addFaces(scene.environment);
  double before = 0.0;
  for (EnvironmentChange& change : scene.environmentChanges) {
    addFaces(change.environment);
    if (!(change.timeSeconds > before) || !std::isfinite(change.timeSeconds))
      throwInputError("environments of scene '{}' want increasing times above 0, '{}' has {} s after {} s", scene.name,
                      change.environment.name, change.timeSeconds, before);
    scene.durationSeconds = std::max(scene.durationSeconds, 2.0 * change.timeSeconds - before);
    before = change.timeSeconds;
  }
}

// What is scaled to a line or a point has no area and no normals.
void warnAboutCollapsed(Scene& scene) {
  const std::vector<WorldMesh> meshes = worldMeshes(scene, 0.0);
  constexpr float kSmallestArea = 1.0f / (kLargestTransform * kLargestTransform);
  std::set<int> named;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const glm::mat3 m(meshes[i].worldFromObject);
    const float area = std::max({glm::length(glm::cross(m[0], m[1])), glm::length(glm::cross(m[1], m[2])),
                                 glm::length(glm::cross(m[2], m[0]))});
    const int node = scene.instances[i].node;
    if (area >= kSmallestArea || !named.insert(node).second) continue;
    std::string warning = fmt::format("node '{}' is scaled to nothing at the start: its mesh is not seen",
                                      scene.nodes[static_cast<std::size_t>(node)].name);
    if (std::ranges::find(scene.warnings, warning) == scene.warnings.end())  // scenes may be finished twice
      scene.warnings.push_back(std::move(warning));
  }
}

void checkScreen(const Scene& scene, const Screen& screen) {
  const bool knownProgram = screen.program >= 0.0f && screen.program < shading::kScreenPrograms &&
                            screen.program == std::floor(screen.program);
  if (!knownProgram)
    throwInputError("screen '{}' of scene '{}' wants a program from 0 to {}, got {}", screen.name, scene.name,
                    shading::kScreenPrograms - 1.0f, screen.program);
  if (std::min(screen.widthPx, screen.heightPx) < 1 || std::max(screen.widthPx, screen.heightPx) > kMaxScreenPx)
    throwInputError("screen '{}' of scene '{}' wants a size from 1x1 to {}x{}, got {}x{}", screen.name, scene.name,
                    kMaxScreenPx, kMaxScreenPx, screen.widthPx, screen.heightPx);
  if (!(screen.periodSeconds > 0.0f) || !std::isfinite(screen.periodSeconds) || !std::isfinite(screen.phase))
    throwInputError("screen '{}' of scene '{}' wants a period above 0 and a finite phase, got {} and {}", screen.name,
                    scene.name, screen.periodSeconds, screen.phase);
}

}  // namespace

void Bounds::include(const glm::vec3& p) {
  lower = glm::min(lower, p);
  upper = glm::max(upper, p);
}

void Bounds::include(const Bounds& other) {
  lower = glm::min(lower, other.lower);
  upper = glm::max(upper, other.upper);
}

Bounds transformed(const Bounds& bounds, const glm::mat4& matrix) {
  Bounds result;
  if (bounds.empty()) return result;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                      (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                      (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z);
    result.include(glm::vec3(matrix * glm::vec4(p, 1.0f)));
  }
  return result;
}

bool ownsProbe(const Scene& scene, const Instance& instance) {
  const Material& material = scene.materials[static_cast<std::size_t>(instance.material)];
  const std::optional<ProbeSettings>& settings = scene.nodes[static_cast<std::size_t>(instance.node)].probe;
  return settings ? settings->enabled && hasSpecularLobe(material) : material.isSpecularDominant;
}

bool deforms(const Scene& scene, const Instance& instance) {
  const Node& node = scene.nodes[static_cast<std::size_t>(instance.node)];
  return node.wave || !instance.mesh->targets.empty() || (node.skin >= 0 && !instance.mesh->joints.empty());
}

void addFramingCamera(Scene& scene) {
  Bounds bounds;
  for (const WorldMesh& m : worldMeshes(scene, 0.0)) bounds.include(transformed(m.mesh->bounds, m.worldFromObject));
  if (bounds.empty()) bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
  const glm::vec3 centre = bounds.centre();
  const float radius = std::max(0.5f * glm::length(bounds.extent()), 1e-3f);
  Camera camera;
  camera.name = "framing";
  camera.verticalFov = glm::radians(40.0f);
  // The bounding sphere just fits the vertical field of view; images are at least as wide as high in practice.
  const float distance = radius / std::sin(0.5f * camera.verticalFov);
  const glm::vec3 eye = centre + distance * glm::normalize(glm::vec3(0.35f, 0.35f, 1.0f));
  camera.zNear = 0.01f * (distance - 0.99f * radius);
  camera.node = static_cast<int>(scene.nodes.size());
  Node node;
  node.name = camera.name;
  node.translation = eye;
  node.rotation = glm::quatLookAt(glm::normalize(centre - eye), glm::vec3(0.0f, 1.0f, 0.0f));
  scene.nodes.push_back(node);
  scene.cameras.push_back(camera);
}

// In the order of the scene; which of them are left out, the brightness at the time decides.
void warnOfTooManyAreaLights(Scene& scene) {
  std::size_t triangles = 0;
  std::string names;
  for (const Instance& instance : scene.instances) {
    const shading::MaterialConstants& m = scene.materials[static_cast<std::size_t>(instance.material)].constants;
    if (m.kind.x == shading::kSurfaceUnlit || glm::vec3(m.emission) == glm::vec3(0.0f)) continue;
    triangles += instance.mesh->triangleCount();
    names += (names.empty() ? "'" : ", '") + instance.name + "'";
  }
  if (triangles <= kMaxAreaLights) return;
  scene.warnings.push_back(
      fmt::format("emissive meshes of {} triangles ({}): under local diffuse light only the brightest meshes with at "
                  "most {} triangles together light others",
                  triangles, names, kMaxAreaLights));
}

void finishScene(Scene& scene) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n)
    if (scene.nodes[n].parent >= static_cast<int>(n))
      throwInputError("node '{}' of scene '{}' stands before its parent", scene.nodes[n].name, scene.name);
  finishDeformations(scene);
  for (const Track& track : scene.tracks) {
    checkTrack(scene, track);
    scene.durationSeconds = std::max(scene.durationSeconds, static_cast<double>(track.timesSeconds.back()));
  }
  for (const Screen& screen : scene.screens) {
    checkScreen(scene, screen);
    scene.durationSeconds = std::max(scene.durationSeconds, static_cast<double>(screen.periodSeconds));
  }
  for (const Node& node : scene.nodes)
    if (node.wave)
      scene.durationSeconds = std::max(scene.durationSeconds, static_cast<double>(node.wave->periodSeconds));
  finishEnvironments(scene);
  warnAboutCollapsed(scene);
  warnOfTooManyAreaLights(scene);
  if (scene.cameras.empty()) {
    addFramingCamera(scene);
    scene.notes.emplace_back("no camera in the scene: added one that frames it");
  }
}

}  // namespace pb
