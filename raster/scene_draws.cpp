#include "raster/scene_draws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <tuple>

#include "raster/lookup.h"
#include "raster/lookup_records.h"
#include "raster/plain_material.h"
#include "raster/refraction.h"
#include "raster/shadow_maps.h"
#include "raster/triangle_lists.h"
#include "scenes/closed_mesh.h"

namespace pb {
namespace {

constexpr const char* kBlendDefines = "#define BLENDED_PROBES\n";
constexpr const char* kPlanarDefines = "#define PLANAR_LOOKUP\n";

// The reference sees glass from inside, too; elsewhere back faces exist only on double-sided materials.
bool cullsBackFaces(const Material& material) {
  return !material.doubleSided && material.constants.kind.x != shading::kSurfaceGlass;
}

bool transmits(const Material& material) { return material.constants.kind.x == shading::kSurfaceGlass; }

// Whatever the time: what screens show changes.
bool mayHaveAreaLights(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& m) {
    return m.constants.kind.x != shading::kSurfaceUnlit && glm::vec3(m.constants.emission) != glm::vec3(0.0f);
  });
}

// llvmpipe pays for the loop over area lights even where there are none: 4.4 ms without and 7.2 ms with it for a plain
// frame of builtin:mirrors?count=5 at 320x180.
std::string areaLightDefines(const Snapshot& snapshot) {
  return mayHaveAreaLights(*snapshot.scene) ? "#define AREA_LIGHTS\n" : "";
}

// Of everything that a mirrored view or the far plane of captures may clip.
std::string clipDefines(const Technique& technique) {
  return lookupOf(technique.lookup).isPlanar || technique.captureFar > 0.0f ? "#define CLIP_PLANE\n" : "";
}

std::string conductorDefines(const Material& material) {
  return material.constants.conductorEta.w > 0.5f ? "#define CONDUCTOR\n" : "";
}

std::string shadowDefines(const Snapshot& snapshot) { return castsShadows(snapshot) ? "#define SHADOWS\n" : ""; }

std::vector<float> kindsOf(const std::vector<shading::Light>& lights) {
  std::vector<float> kinds;
  for (const shading::Light& light : lights) kinds.push_back(light.positionKind.w);
  return kinds;
}

// Lights of known number and kind: llvmpipe 22 takes long over loops that it can't unroll (docs/performance.md).
// More than fit into the smallest uniform block that OpenGL 4.5 promises (16 KiB) are read from a storage block.
std::string punctualLightDefines(const std::vector<float>& kinds) {
  constexpr std::size_t kMaxKnown = 16384 / sizeof(shading::Light);
  if (kinds.empty()) return "";
  const std::string count = fmt::format("#define LIGHT_COUNT {}\n", kinds.size());
  if (kinds.size() > kMaxKnown) return count;
  return count + fmt::format("#define LIGHT_KINDS float[]({:.1f})\n", fmt::join(kinds, ", "));
}

std::string lightDefines(const Snapshot& snapshot, bool showsLights) {
  if (!showsLights) return "#define NO_LIGHTS\n";
  return punctualLightDefines(kindsOf(snapshot.lights)) + shadowDefines(snapshot) + areaLightDefines(snapshot);
}

// How lookups read the maps of probes.
std::string mapDefines(const Technique& technique, const Snapshot& snapshot) {
  std::string defines;
  if (technique.storage == Storage::octahedral) defines += "#define MAP_OCTAHEDRAL\n";
  if (technique.storage == Storage::dualParaboloid) defines += "#define MAP_PARABOLOIDS\n";
  if (!technique.mips) return defines;
  const bool hasLobes = levelFilter(technique, snapshot) == ProbeFilter::ggxPrefiltered;
  return defines + (hasLobes ? "#define MIPS\n#define MIPS_GGX\n" : "#define MIPS\n");
}

// What is drawn as rest + weight * radiance of one direction.
bool hasOneLookup(const SurfaceVariant& variant) {
  return (variant.kind == shading::kSurfaceMirror || variant.kind == shading::kSurfaceGlossy) &&
         variant.coverage != shading::kAlphaBlend;
}

// The same everywhere: shows nothing but what it looks up, at level 0, weighted as its constants and the cosine to the
// viewer say.
bool isUniformMirror(const Technique& technique, const Material& material, const Mesh& mesh) {
  const shading::MaterialConstants& m = material.constants;
  return m.kind.x == shading::kSurfaceMirror && m.factors.x == 1.0f && glm::vec3(m.emission) == glm::vec3(0.0f) &&
         material.baseColorTexture < 0 && material.metallicRoughnessTexture < 0 && mesh.colors.empty() &&
         !technique.mips;
}

SurfaceVariant variantOf(const Technique& technique, const Snapshot& snapshot, const SnapshotInstance& instance,
                         const SceneResources& resources) {
  SurfaceVariant variant = resources.variantOf(instance.material, *instance.mesh, technique.textureFilter);
  variant.reflects = reflectionOf(technique, snapshot, instance).source != ReflectionSource::nothing;
  if (lookupOf(technique.lookup).isSingleView && !instance.mesh->uvs[0].empty()) variant.attributes = true;
  return variant;
}

// Levels of a second probe are read as those of the first. The nearest probe of an instance may become another one.
int mapResolution(const Technique& technique, const Snapshot& snapshot, const SnapshotInstance& instance,
                  const std::vector<int>& probeResolutions) {
  const Reflection reflection = reflectionOf(technique, snapshot, instance);
  return reflection.source == ReflectionSource::probe ? probeResolutions[static_cast<std::size_t>(reflection.probe)]
                                                      : technique.resolution;
}

// Finds the programs of a snapshot's surfaces.
class SurfacePrograms {
 public:
  SurfacePrograms(Programs& programs, const Technique& technique, const Snapshot& snapshot, int environmentSize)
      : programs_(programs),
        technique_(technique),
        snapshot_(snapshot),
        source_(environmentSource(snapshot.environment(), technique.textureFilter)),
        environment_(environmentConstants(snapshot.environment())),
        settings_(techniqueDefines(technique) + clipDefines(technique) + environment_),
        environmentLevels_(filterDefines(technique.filter, environmentSize)),
        mapLookup_(lookupDefines(technique.lookup) + mapDefines(technique, snapshot)),
        lookupCode_(lookupOf(technique.lookup).glsl) {}

  GLuint background() { return programs_.background(source_, environment_); }

  // Sets the programs of a draw whose other members are set.
  void find(SurfaceDraw& draw) {
    const SnapshotInstance& instance = snapshot_.instances[draw.instance];
    const Material& material = snapshot_.materialOf(instance);
    const Reflection reflection = reflectionOf(technique_, snapshot_, instance);
    const std::string ofMaterial = settings_ + refractionDefines(technique_, material) + conductorDefines(material);
    const std::string defines = ofMaterial + lightDefines(snapshot_, true);
    const std::string map = filterDefines(mapFilter(technique_), draw.mapResolution) + mapLookup_;
    const bool hasBackFaces = readsBackFaces(technique_, material);
    draw.shown = showing(draw.variant, reflection, defines, map, hasBackFaces);
    if (lookupOf(technique_.lookup).isPlanar && instance.probe >= 0)
      draw.showingMirroredView = showingMirroredView(draw.variant, defines, map, transmits(material));
    if (castsShadows(snapshot_)) draw.shadow = programs_.shadow(draw.variant);

    const SurfaceVariant captured =
        technique_.captureTextures ? draw.variant : plainVariant(draw.variant, *instance.mesh);
    const std::string capturedDefines = ofMaterial + lightDefines(snapshot_, technique_.captureLights);
    static_cast<SurfaceDraw::Shown&>(draw.captured) = showing(captured, reflection, capturedDefines, map, hasBackFaces);
    if (!repeatsLookups(technique_)) return;
    if (draw.captured.showingProbe == 0 || !hasOneLookup(draw.variant)) return;
    if (isUniformMirror(technique_, material, *instance.mesh)) draw.captured.record = LookupRecord::mirror;
    draw.captured.recordingProbe =
        programs_.surfaceRecordingLookup(captured, draw.captured.record, capturedDefines + map, lookupCode_);
  }

 private:
  SurfaceDraw::Shown showing(const SurfaceVariant& variant, const Reflection& reflection, const std::string& defines,
                             const std::string& map, bool hasBackFaces) {
    SurfaceDraw::Shown shown;
    shown.showingEnvironment = programs_.surfaceShowingEnvironment(variant, source_, defines + environmentLevels_);
    if (reflection.source == ReflectionSource::probe)
      shown.showingProbe = programs_.surfaceShowingProbe(variant, defines + map, lookupCode_);
    if (reflection.second >= 0)
      shown.showingBlend = programs_.surfaceShowingProbe(variant, defines + map + kBlendDefines, lookupCode_);
    if (hasBackFaces) shown.backFaces = programs_.backFaces(variant);
    return shown;
  }

  GLuint showingMirroredView(const SurfaceVariant& variant, const std::string& defines, const std::string& map,
                             bool refracts) {
    if (refracts) return programs_.surfaceShowingProbe(variant, defines + map + kPlanarDefines, lookupCode_);
    return programs_.surfaceShowingEnvironment(variant, source_, defines + environmentLevels_ + kPlanarDefines);
  }

  Programs& programs_;
  const Technique& technique_;
  const Snapshot& snapshot_;
  const EnvironmentSource source_;
  const std::string environment_;
  const std::string settings_;
  const std::string environmentLevels_;
  const std::string mapLookup_;
  const std::string_view lookupCode_;
};

}  // namespace

void SceneDraws::show(const Snapshot& snapshot, SceneResources& resources, const std::vector<int>& probeResolutions,
                      bool isNew) {
  if (isNew) isClosed_.clear();
  if (isNew || !fit(snapshot, probeResolutions)) build(snapshot, resources, probeResolutions);
  for (const SurfaceDraw& draw : draws_) {
    const SnapshotInstance& instance = snapshot.instances[draw.instance];
    if (instance.mesh->isDeformed)
      resources.mesh(draw.instance, instance.mesh, meshNeeds(snapshot, instance, draw.shown.backFaces != 0));
  }
}

bool SceneDraws::isClosed(const Mesh& mesh) {
  const std::array meshes = {&mesh};
  if (mesh.isDeformed) return boundaryOf(meshes) == Boundary::closed;
  const auto [found, isNew] = isClosed_.try_emplace(&mesh, false);
  if (isNew) found->second = boundaryOf(meshes) == Boundary::closed;
  return found->second;
}

bool SceneDraws::haveBackFaces() const {
  return std::ranges::any_of(draws_, [](const SurfaceDraw& draw) { return draw.shown.backFaces != 0; });
}

// A deforming instance keeps its draw whatever its shape: topology is the same.
bool SceneDraws::fit(const Snapshot& snapshot, const std::vector<int>& probeResolutions) const {
  if (environment_ != snapshot.environmentIndex || resolutions_ != probeResolutions) return false;
  if (lightKinds_ != kindsOf(snapshot.lights)) return false;
  return draws_.size() == snapshot.instances.size() && std::ranges::all_of(draws_, [&](const SurfaceDraw& draw) {
           const SnapshotInstance& instance = snapshot.instances[draw.instance];
           const bool deforms = draw.source->isDeformed && instance.mesh->isDeformed;
           return (draw.source == instance.mesh || deforms) && draw.material == instance.material &&
                  draw.mapResolution == mapResolution(technique_, snapshot, instance, probeResolutions);
         });
}

// Blended surfaces last, then sorted by what is dear to change. Nothing here may depend on addresses or GL names: the
// order decides which of two coinciding surfaces is seen, and how many fragments pass.
void SceneDraws::build(const Snapshot& snapshot, SceneResources& resources, const std::vector<int>& probeResolutions) {
  const int environmentSize = resources.filterEnvironment(technique_.filter, device_.programs);
  SurfacePrograms programs(device_.programs, technique_, snapshot, environmentSize);
  background_ = programs.background();
  environment_ = snapshot.environmentIndex;
  lightKinds_ = kindsOf(snapshot.lights);
  resolutions_ = probeResolutions;
  draws_.clear();
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    const SnapshotInstance& instance = snapshot.instances[i];
    const Material& material = snapshot.materialOf(instance);
    const MeshNeeds needs = meshNeeds(snapshot, instance, readsBackFaces(technique_, material));
    draws_.push_back({.variant = variantOf(technique_, snapshot, instance, resources),
                      .material = instance.material,
                      .instance = i,
                      .source = instance.mesh,
                      .mesh = &resources.mesh(i, instance.mesh, needs),
                      .cullsBackFaces = cullsBackFaces(material),
                      .isClosedGlass = isSolidGlass(material) && !material.doubleSided && isClosed(*instance.mesh),
                      .isCapturedFromInside = isCapturedFromInside(technique_, material),
                      .mapResolution = mapResolution(technique_, snapshot, instance, probeResolutions),
                      .shown = {},
                      .captured = {}});
    programs.find(draws_.back());
  }
  std::ranges::sort(draws_, {},
                    [](const SurfaceDraw& d) { return std::tuple(d.isBlended(), d.variant, d.material, d.instance); });
  device_.context.check("uploading a scene's meshes");
}

MeshNeeds SceneDraws::meshNeeds(const Snapshot& snapshot, const SnapshotInstance& instance, bool hasBackFaces) const {
  const std::vector<Instance>& instances = snapshot.scene->instances;
  return {.inwardDistances = hasBackFaces,
          .share = technique_.captureLod,
          .planes = device_.dropsUnseenTriangles && isWorthCulling(*instance.mesh),
          .rest = instances[static_cast<std::size_t>(instance.source)].mesh.get()};
}

}  // namespace pb
