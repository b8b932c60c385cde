// The scene model: geometry, materials, lights, environment, cameras, animation. Right-handed, +Y up, metres, seconds,
// radians; glTF cameras look down -Z; radiance linear Rec.709. A Scene is built once (by the glTF loader or in code),
// then only read. Renderers never see it: they get Snapshots (snapshot.h).
#pragma once

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/image.h"
#include "scenes/shading/shading.h"

namespace pb {

// Axis-aligned box; the default one is empty.
struct Bounds {
  glm::vec3 lower{std::numeric_limits<float>::infinity()};
  glm::vec3 upper{-std::numeric_limits<float>::infinity()};

  bool empty() const { return lower.x > upper.x; }
  glm::vec3 centre() const { return 0.5f * (lower + upper); }
  glm::vec3 extent() const { return upper - lower; }
  void include(const glm::vec3& p);
  void include(const Bounds& other);
};

// Box around the transformed box.
Bounds transformed(const Bounds& bounds, const glm::mat4& matrix);

// Decoded to linear float; level 0 first, each next level half the size (rounded down, at least 1) by box filter.
struct Texture {
  std::string name;
  std::vector<ImageRgba> levels;
};

// All levels from level 0; texels must be linear.
Texture makeTexture(std::string name, ImageRgba level0);

// What a morph target adds to a mesh at weight 1, one entry a vertex. Normals and tangents may be empty.
struct MorphTarget {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec3> tangents;
};

// Triangles of one material (a glTF primitive), indexed. All arrays but the optional ones have one entry a vertex.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;             // unit
  std::vector<glm::vec4> tangents;            // optional; w is the bitangent's sign
  std::array<std::vector<glm::vec2>, 2> uvs;  // optional
  std::vector<glm::vec4> colors;              // optional; linear
  std::vector<std::uint32_t> indices;         // 3 a triangle, counter-clockwise seen from outside

  // Of meshes at rest that may deform (scenes/deformation.h).
  std::vector<MorphTarget> targets;
  std::vector<glm::u16vec4> joints;     // optional; indices into Skin::joints, with
  std::vector<glm::vec4> jointWeights;  // >= 0, of sum 1

  // Made by finishMesh().
  bool hasFlatNormals = false;                 // computed, because none were given
  bool isDeformed = false;                     // one shape of many with the same topology (scenes/deformation.h)
  std::vector<float> uvPerMetre;               // sqrt(UV area / area) in object space, mean of the adjacent triangles
  std::vector<std::uint32_t> smoothingGroups;  // one a triangle: triangles that share a vertex are of one group
  Bounds bounds;
  std::uint64_t contentHash = 0;

  std::size_t triangleCount() const { return indices.size() / 3; }
};

// Completes a mesh: computes flat normals where there are none (splitting vertices), tangents if `needsTangents` and
// there are none (from the texture coordinates of the given set, splitting vertices), and the derived members. Makes
// joint weights sum to 1. Drops triangles without area, unless a deformation may give them one. Throws an input Error
// naming the mesh for what is not finite, for indices out of range, for members of different lengths and for joint
// weights that can't sum to 1.
std::shared_ptr<const Mesh> finishMesh(Mesh mesh, bool needsTangents = false, int tangentUvSet = 0);

// Perceptual roughness below which a metal counts as specular-dominant.
inline constexpr float kSmoothRoughness = 0.3f;

struct Material {
  std::string name;
  shading::MaterialConstants constants;  // texture slots' w is set iff the texture below is
  // Indices into Scene::textures, -1 for none, in the order of the slots in MaterialConstants.
  int baseColorTexture = -1;
  int metallicRoughnessTexture = -1;
  int normalTexture = -1;
  int emissionTexture = -1;
  int occlusionTexture = -1;
  int screen = -1;  // index into Scene::screens: its picture takes the place of the emission texture
  bool doubleSided = false;
  // Its instances get a probe and are scored on the mask: metallic > 0.5 with roughness < 0.3 (means over the texture),
  // or transmission > 0.5.
  bool isSpecularDominant = false;

  // KHR_materials_volume, as absorption in `constants`: set by setAttenuation().
  float attenuationDistance = std::numeric_limits<float>::infinity();
  glm::vec3 attenuationColor{1.0f};
};

// White light becomes `color` after `distance` metres inside; infinite for no absorption. A channel of 0 counts as
// 1e-6.
void setAttenuation(Material& material, glm::vec3 color, float distance);

// A matte material: every factor at glTF's default except metallic and the specular factor, which are 0.
Material makeDiffuseMaterial(std::string name, glm::vec3 albedo);
// A perfect mirror (reflectance 1), or a smooth metal of the given F0.
Material makeMirrorMaterial(std::string name, glm::vec3 f0 = glm::vec3(1.0f));
// A metal of perceptual roughness `roughness`, by its complex index of refraction eta + i k per channel.
Material makeMetalMaterial(std::string name, glm::vec3 eta, glm::vec3 k, float roughness);
// Clear smooth glass that fills the mesh; thickness (metres) is what rasterisers assume that light crosses.
Material makeGlassMaterial(std::string name, float ior, float thickness = 1.0f);

// Whether the node's instances with a specular lobe get a probe, and where it stands. Distances in metres.
struct ProbeSettings {
  bool enabled = true;
  std::optional<glm::vec3> position;  // in the node's space; otherwise the centre of the world bounding box
  std::optional<Bounds> box{};        // world space: what a box proxy takes for the surroundings; otherwise Scene::room
};

// Bounds of translations, scales and matrices, of single nodes and in world space, where they multiply: the product of
// three, a determinant, still fits into float.
inline constexpr float kLargestTransform = 1e9f, kLargestWorldTransform = 1e12f;

// A wave that runs along +X through an object and moves its vertices along Z: at x >= 0 by
// amplitude * (x / length) * sin(2 pi (x / wavelength + skew * y - t / periodSeconds)). What lies at x <= 0 is held, as
// by a flag's staff. Object space, metres.
struct Wave {
  float amplitude = 0.1f;      // at x = length
  float length = 1.0f;         // > 0
  float wavelength = 1.0f;     // > 0
  float skew = 0.0f;           // periods a metre along Y: crests lean
  float periodSeconds = 1.0f;  // > 0
};

struct Node {
  std::string name;
  int parent = -1;  // always smaller than the node's own index
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  // w x y z
  glm::vec3 scale{1.0f};
  std::optional<glm::mat4> matrix;  // instead of the three above; not animated
  std::optional<ProbeSettings> probe;
  // Deformation of its instances. Instances whose mesh has joints stand where the skin's joints are, not at the node.
  std::vector<float> morphWeights;  // one a morph target of its meshes
  std::optional<Wave> wave;
  int skin = -1;  // index into Scene::skins
};

// Nodes that move a mesh (glTF 2.0, section 3.7.3): a vertex p goes to the sum of
// weight * worldFromNode(joint) * inverseBindMatrix * p over its joints.
struct Skin {
  std::string name;
  std::vector<int> joints;                     // nodes
  std::vector<glm::mat4> inverseBindMatrices;  // one a joint
};

// One mesh at one node. Instances are numbered as they stand in Scene::instances; ids in images are index + 1.
struct Instance {
  std::string name;
  int node = 0;
  std::shared_ptr<const Mesh> mesh;
  int material = 0;
};

struct PunctualLight {
  int node = 0;  // shines along the node's -Z
  float kind = shading::kLightDirectional;
  glm::vec3 intensity{1.0f};  // W/m^2 or W/sr
  float range = 0.0f;         // metres, 0 for none
  float innerConeAngle = 0.0f;
  float outerConeAngle = 0.78539816f;
};

struct Camera {
  std::string name;
  int node = 0;  // looks along the node's -Z, +Y up
  float verticalFov = 0.7853982f;
  float zNear = 0.1f;
};

enum class TrackTarget { translation, rotation, scale, morphWeights };
enum class Interpolation { step, linear, cubicSpline };

// Key frames of one property of one node. Values are xyz or, for rotations, xyzw; cubic splines hold
// (in-tangent, value, out-tangent) for each key (glTF 2.0, appendix C). Times increase strictly. Morph weights stand in
// `weights` instead, where each value is one number a target.
struct Track {
  int node = 0;
  TrackTarget target = TrackTarget::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> timesSeconds;
  std::vector<glm::vec4> values;
  std::vector<float> weights;
};

// Value of a track, held constant before its first and after its last key. sampleWeights() is for tracks of morph
// weights, sampleTrack() for all others.
glm::vec4 sampleTrack(const Track& track, double timeSeconds);
std::vector<float> sampleWeights(const Track& track, double timeSeconds);

struct Environment {
  std::string name = "sky";
  shading::Sky sky;              // with toGlow.w = 1 the faces below are the environment
  std::vector<ImageRgba> faces;  // six square faces in GL order, or one black texel a face if not used
  shading::Ambient ambient;      // light of the environment on diffuse surfaces
};

// Another environment that takes the place of the one before from a time on.
struct EnvironmentChange {
  double timeSeconds = 0.0;
  Environment environment;
};

// A picture that a program of shading/screen.glsl draws anew for every time, and that materials show as their emission.
struct Screen {
  std::string name;
  float program = shading::kScreenMelt;  // kScreen*
  int widthPx = 96;
  int heightPx = 72;
  float periodSeconds = 4.0f;  // of the loop that it shows
  float phase = 0.0f;          // where in the loop it starts, in periods
};

struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Screen> screens;
  std::vector<Material> materials;
  std::vector<Node> nodes;
  std::vector<Skin> skins;
  std::vector<Instance> instances;
  std::vector<PunctualLight> lights;
  std::vector<Camera> cameras;  // at least one
  std::vector<Track> tracks;
  Environment environment;                            // from time 0 on
  std::vector<EnvironmentChange> environmentChanges;  // times > 0, increasing
  bool castsShadows = false;      // of lights on diffuse surfaces: traced in the reference, shadow-mapped in the raster
  double framesPerSecond = 30.0;  // frame f is the scene at time f / framesPerSecond, looped over durationSeconds
  double durationSeconds = 0.0;   // end of what lasts longest (see finishScene()); 0: nothing moves
  float probeNear = 0.01f;        // near plane of cube captures, metres
  std::optional<Bounds> room;     // world space: the box of probes without one of their own
  std::vector<std::string> warnings;  // what the loader ignored, one sentence each
  std::vector<std::string> notes;     // what the loader added (default camera, sky, ...)

  // 0: `environment`, 1 and up: the changes.
  const Environment& environmentAt(std::size_t index) const {
    return index == 0 ? environment : environmentChanges[index - 1].environment;
  }
};

// Whether the instance's mesh is another one at every time.
bool deforms(const Scene& scene, const Instance& instance);

// Whether the material reflects or refracts specularly at all.
bool hasSpecularLobe(const Material& material);

// Whether the instance is shaded by a probe of its own: one with a specular lobe, if its node asks for a probe; without
// settings at the node, a specular-dominant one.
bool ownsProbe(const Scene& scene, const Instance& instance);

// Last steps of building any scene: checks indices, tracks, skins and the transforms at time 0, adds a camera that
// frames everything if there is none, gives unused environments their black faces, and computes durationSeconds: the
// longest of all tracks, of the periods of screens and waves, and of the environments, of which the last one is there
// as long as the one before it.
void finishScene(Scene& scene);

// A camera that sees the whole box from the front and a little above.
void addFramingCamera(Scene& scene);

// "builtin:NAME[?k=v..]" or a path to .gltf, .glb or .obj, with options
// environment=FILE|sky|..[;FILE|sky|..@SECONDS].., shadows=none|traced, fps=F or time_step=SECONDS, and
// mirror=NODE|all. Throws an input Error for anything that is not a scene.
std::shared_ptr<const Scene> loadScene(const std::string& reference);

}  // namespace pb
