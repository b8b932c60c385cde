// `flag-and-horse`: a waving flag and a trotting horse circle a mirror teapot: geometry that deforms and geometry that
// moves, before probes that see both (for refresh policies).
#include <array>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/builtin/shapes.h"
#include "scenes/builtin/teapot_mesh.h"
#include "scenes/environment.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr float kOrbitSeconds = 6.0f;
constexpr float kStrideSeconds = 0.6f;
constexpr float kWaveSeconds = 1.0f;
constexpr float kOrbitRadius = 2.6f;

int addNode(Scene& scene, std::string name, int parent, glm::vec3 translation = glm::vec3(0.0f)) {
  Node node;
  node.name = std::move(name);
  node.parent = parent;
  node.translation = translation;
  scene.nodes.push_back(std::move(node));
  return static_cast<int>(scene.nodes.size()) - 1;
}

void addPart(Scene& scene, const std::string& name, int parent, const std::shared_ptr<const Mesh>& mesh, int material,
             glm::vec3 translation, glm::vec3 scale = glm::vec3(1.0f), float pitchDegrees = 0.0f) {
  Node node;
  node.parent = parent;
  node.translation = translation;
  node.scale = scale;
  node.rotation = glm::angleAxis(glm::radians(pitchDegrees), glm::vec3(0, 0, 1));
  addInstance(scene, name, mesh, material, node);
}

// `count` equal steps of a rotation, closed; linear key frames between them are exact for turns at constant speed.
template <class Angle>
Track rotationTrack(int node, glm::vec3 axis, float periodSeconds, int steps, const Angle& radiansAt) {
  Track track;
  track.node = node;
  track.target = TrackTarget::rotation;
  for (int i = 0; i <= steps; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(steps);
    const glm::quat q = glm::angleAxis(radiansAt(share), axis);
    track.timesSeconds.push_back(periodSeconds * share);
    track.values.emplace_back(q.x, q.y, q.z, q.w);
  }
  return track;
}

// Repeats a track until `seconds`, a whole multiple of its end.
Track repeated(const Track& track, float seconds) {
  Track result = track;
  const float period = track.timesSeconds.back();
  for (int loop = 1; static_cast<float>(loop) < seconds / period - 0.5f; ++loop)
    for (std::size_t k = 1; k < track.timesSeconds.size(); ++k) {
      result.timesSeconds.push_back(static_cast<float>(loop) * period + track.timesSeconds[k]);
      result.values.push_back(track.values[k]);
    }
  return result;
}

// Swings around Z by +-degrees, starting at `phase` of its period.
void swing(Scene& scene, int node, float degrees, float centreDegrees, float phase) {
  const auto angleAt = [&](float share) {
    return glm::radians(centreDegrees + degrees * glm::sin(glm::two_pi<float>() * (share + phase)));
  };
  scene.tracks.push_back(repeated(rotationTrack(node, {0, 0, 1}, kStrideSeconds, 12, angleAt), kOrbitSeconds));
}

// Upper and lower leg, both hinged; the lower one lags behind.
void addLeg(Scene& scene, const std::string& name, int body, glm::vec3 hip, float phase, int coat, int hoof) {
  const auto limb = finishMesh(makeBoxMesh({0.11f, 0.34f, 0.11f}));
  const auto foot = finishMesh(makeBoxMesh({0.13f, 0.07f, 0.13f}));
  const int upper = addNode(scene, name + " hip", body, hip);
  addPart(scene, name + " upper", upper, limb, coat, {0.0f, -0.15f, 0.0f});
  const int lower = addNode(scene, name + " knee", upper, {0.0f, -0.30f, 0.0f});
  addPart(scene, name + " lower", lower, limb, coat, {0.0f, -0.14f, 0.0f}, {0.8f, 0.9f, 0.8f});
  addPart(scene, name + " hoof", lower, foot, hoof, {0.0f, -0.31f, 0.0f});
  swing(scene, upper, 28.0f, 4.0f, phase);
  swing(scene, lower, 24.0f, -24.0f, phase - 0.2f);
}

// Looks along +X.
void addHorse(Scene& scene, int parent) {
  const int coat = addMaterial(scene, makeDiffuseMaterial("Coat", {0.42f, 0.20f, 0.09f}));
  const int mane = addMaterial(scene, makeDiffuseMaterial("Mane", {0.06f, 0.045f, 0.035f}));
  const auto ball = finishMesh(makeSphereMesh(1.0f, 32, 16));
  const auto box = finishMesh(makeBoxMesh(glm::vec3(1.0f)));
  const int body = addNode(scene, "Horse", parent, {0.0f, 0.88f, 0.0f});
  addPart(scene, "Trunk", body, ball, coat, {0, 0, 0}, {0.58f, 0.27f, 0.24f});
  addPart(scene, "Chest", body, ball, coat, {0.34f, 0.03f, 0}, {0.27f, 0.29f, 0.22f});
  addPart(scene, "Croup", body, ball, coat, {-0.36f, 0.04f, 0}, {0.28f, 0.28f, 0.23f});
  const int neck = addNode(scene, "Neck joint", body, {0.45f, 0.12f, 0.0f});
  addPart(scene, "Neck", neck, ball, coat, {0.16f, 0.22f, 0}, {0.13f, 0.36f, 0.11f}, -35.0f);
  addPart(scene, "Mane", neck, box, mane, {0.09f, 0.27f, 0}, {0.07f, 0.52f, 0.04f}, -35.0f);
  addPart(scene, "Head", neck, ball, coat, {0.46f, 0.44f, 0}, {0.26f, 0.11f, 0.10f}, -28.0f);
  for (const float side : {-1.0f, 1.0f})
    addPart(scene, "Ear", neck, box, mane, {0.31f, 0.59f, 0.06f * side}, {0.05f, 0.12f, 0.04f}, 10.0f);
  swing(scene, neck, 6.0f, 0.0f, 0.1f);
  const int tail = addNode(scene, "Tail joint", body, {-0.6f, 0.12f, 0.0f});
  addPart(scene, "Tail", tail, ball, mane, {-0.07f, -0.26f, 0}, {0.06f, 0.32f, 0.06f}, -12.0f);
  swing(scene, tail, 14.0f, -10.0f, 0.4f);
  // A trot: diagonal pairs in step.
  addLeg(scene, "Front left", body, {0.36f, -0.14f, 0.13f}, 0.0f, coat, mane);
  addLeg(scene, "Front right", body, {0.36f, -0.14f, -0.13f}, 0.5f, coat, mane);
  addLeg(scene, "Hind left", body, {-0.38f, -0.14f, 0.13f}, 0.5f, coat, mane);
  addLeg(scene, "Hind right", body, {-0.38f, -0.14f, -0.13f}, 0.0f, coat, mane);
}

// In its plane at rest: hoisted at x = 0.
Mesh makeFlagMesh(glm::vec2 size, int columns, int rows) {
  Mesh mesh;
  mesh.name = "flag";
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const glm::vec2 uv(static_cast<float>(i) / static_cast<float>(columns),
                         static_cast<float>(j) / static_cast<float>(rows));
      mesh.positions.emplace_back(uv * size, 0.0f);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      mesh.uvs[0].push_back(uv);
    }
  const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      mesh.indices.insert(mesh.indices.end(), {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j),
                                               vertex(i + 1, j + 1), vertex(i, j + 1)});
  return mesh;
}

Texture makeStripes() {
  static constexpr std::array<glm::vec3, 3> kColors = {
      {{0.05f, 0.16f, 0.52f}, {0.85f, 0.83f, 0.78f}, {0.70f, 0.07f, 0.06f}}};
  ImageRgba texels(96, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x) {
      const glm::vec2 toDisc = glm::vec2(static_cast<float>(x) - 47.5f, static_cast<float>(y) - 31.5f) / 14.0f;
      const bool isDisc = glm::dot(toDisc, toDisc) < 1.0f;
      texels(x, y) = roundedToBytes(
          glm::vec4(isDisc ? glm::vec3(0.85f, 0.55f, 0.05f) : kColors[static_cast<std::size_t>(y * 3 / 64)], 1.0f));
    }
  return makeTexture("flag", std::move(texels));
}

void addFlag(Scene& scene, int parent) {
  constexpr glm::vec2 kSize(1.5f, 0.95f);
  const int staff = addMaterial(scene, makeDiffuseMaterial("Staff", {0.32f, 0.22f, 0.12f}));
  const auto pole = finishMesh(makeBoxMesh({0.06f, 2.5f, 0.06f}));
  const int stand = addNode(scene, "Flag stand", parent);
  addPart(scene, "Staff", stand, pole, staff, {-0.03f, 1.25f, 0.0f});
  Material cloth = makeTexturedMaterial("Cloth", addTexture(scene, makeStripes()), {1.0f, 1.0f});
  cloth.doubleSided = true;
  Node node;
  node.parent = stand;
  node.translation = {0.0f, 1.5f, 0.0f};
  node.wave =
      Wave{.amplitude = 0.2f, .length = kSize.x, .wavelength = 1.1f, .skew = 0.35f, .periodSeconds = kWaveSeconds};
  addInstance(scene, "Flag", finishMesh(makeFlagMesh(kSize, 60, 36)), addMaterial(scene, std::move(cloth)), node);
}

Texture makePaving() {
  ImageRgba texels(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const float tone = (x / 32 + y / 32) % 2 == 0 ? 1.0f : 0.6f;
      texels(x, y) = roundedToBytes(glm::vec4(tone * glm::vec3(0.50f, 0.47f, 0.40f), 1.0f));
    }
  return makeTexture("paving", std::move(texels));
}

void addGround(Scene& scene) {
  const int paving = addTexture(scene, makePaving());
  addInstance(scene, "Ground", finishMesh(makeQuadMesh({-8, 0, 8}, {16, 0, 0}, {0, 0, -16})),
              addMaterial(scene, makeTexturedMaterial("Ground", paving, {8.0f, 8.0f})));
}

}  // namespace

Scene makeFlagAndHorseScene(SpecReader& /*parameters*/) {
  Scene scene;
  addGround(scene);
  Node middle;
  middle.translation = {0.0f, 0.25f, 0.0f};
  middle.rotation = glm::angleAxis(glm::radians(-25.0f), glm::vec3(0, 1, 0));
  addInstance(scene, "Mirror teapot", finishMesh(makeTeapotMesh(10)),
              addMaterial(scene, makeMirrorMaterial("Mirror", {0.95f, 0.94f, 0.92f})), middle);
  addInstance(scene, "Plinth", finishMesh(makeBoxMesh({2.2f, 0.5f, 2.2f})),
              addMaterial(scene, makeDiffuseMaterial("Plinth", glm::vec3(0.35f, 0.36f, 0.38f))));

  const int carousel = addNode(scene, "Orbit", -1);
  scene.tracks.push_back(
      rotationTrack(carousel, {0, 1, 0}, kOrbitSeconds, 8, [](float share) { return glm::two_pi<float>() * share; }));
  // On a turn around +Y what stands at +Z moves towards +X, where the horse looks.
  addHorse(scene, addNode(scene, "Horse place", carousel, {0.0f, 0.0f, kOrbitRadius}));
  // Streams behind its staff.
  const int flagPlace = addNode(scene, "Flag place", carousel, {0.0f, 0.0f, -kOrbitRadius});
  addFlag(scene, flagPlace);

  addCamera(scene, "Camera", {0.9f, 2.3f, 7.0f}, {0.0f, 1.0f, 0.0f}, glm::radians(38.0f), 0.1f);
  addDirectionalLight(scene, "Sun", {0.5f, 0.9f, 0.6f}, glm::vec3(2.5f, 2.4f, 2.2f));
  scene.environment = makeProceduralSky();
  return scene;
}

}  // namespace pb
