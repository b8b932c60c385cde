#include "raster/scene_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tuple>

#include "raster/culling.h"
#include "raster/lookup.h"
#include "raster/plain_material.h"
#include "raster/planar.h"
#include "raster/probe_maps.h"
#include "raster/proxy.h"
#include "raster/refraction.h"
#include "scenes/closed_mesh.h"

namespace pb {
namespace {

constexpr const char* kBlendDefines = "#define BLENDED_PROBES\n";
constexpr const char* kPlanarDefines = "#define PLANAR_LOOKUP\n";

gpu::InstanceConstants constantsOf(const SnapshotInstance& instance, const Reflection& reflection) {
  return {.worldFromObject = instance.worldFromObject,
          .normalMatrix = glm::mat4(instance.normalMatrix),
          .values = {instance.uvScale, 0.0f, static_cast<float>(instance.source + 1), instance.mirrored ? -1.0f : 1.0f},
          .volume = {std::cbrt(std::abs(glm::determinant(glm::mat3(instance.worldFromObject)))),
                     reflection.secondWeight, 0.0f, 0.0f}};
}

// Counter-clockwise triangles stay so on their way to the window if s, t and forward are as left-handed as x, y and
// depth of GL's window; views and transforms may each turn them round.
GLenum frontFace(const shading::View& view, bool mirrored) {
  const float handedness = glm::dot(glm::cross(glm::vec3(view.right), glm::vec3(view.down)), glm::vec3(view.forward));
  return (handedness > 0.0f) != mirrored ? GL_CW : GL_CCW;
}

// The reference sees glass from inside, too; elsewhere back faces exist only on double-sided materials.
bool cullsBackFaces(const Material& material) {
  return !material.doubleSided && material.constants.kind.x != shading::kSurfaceGlass;
}

bool transmits(const Material& material) { return material.constants.kind.x == shading::kSurfaceGlass; }

bool isClosed(const Mesh& mesh) {
  const std::array meshes = {&mesh};
  return boundaryOf(meshes) == Boundary::closed;
}

// Whether no point of the near plane is inside of the box.
bool isViewedFromOutside(const Bounds& box, const shading::View& view) {
  const float reach = view.origin.w * (glm::length(glm::vec3(view.forward)) + glm::length(glm::vec3(view.right)) +
                                       glm::length(glm::vec3(view.down)));
  const glm::vec3 origin(view.origin);
  return glm::distance(glm::clamp(origin, box.lower, box.upper), origin) > reach;
}

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

bool isClipped(const gpu::PassConstants& pass) { return glm::vec3(pass.clip) != glm::vec3(0.0f); }

// Whatever lies in the plane of a mirrored view counts as behind it: the reflector would hide what it reflects.
bool isClippedAway(const Bounds& box, const gpu::PassConstants& pass) {
  const float size = glm::length(box.extent());
  return isClipped(pass) && isBehindPlane(box, glm::vec3(pass.clip), pass.clip.w - kPlanarThickness * size);
}

std::string conductorDefines(const Material& material) {
  return material.constants.conductorEta.w > 0.5f ? "#define CONDUCTOR\n" : "";
}

// What is drawn as rest + weight * radiance of one direction.
bool hasOneLookup(const SurfaceVariant& variant) {
  return (variant.kind == shading::kSurfaceMirror || variant.kind == shading::kSurfaceGlossy) &&
         variant.coverage != shading::kAlphaBlend;
}

// By the order of draws, diffuse surfaces come before all that look something up.
bool mayCoverLookups(const SurfaceVariant& variant) {
  return variant.kind != shading::kSurfaceDiffuse && variant.coverage != shading::kAlphaBlend;
}

std::string shadowDefines(const Snapshot& snapshot) { return castsShadows(snapshot) ? "#define SHADOWS\n" : ""; }

std::string lightDefines(const Snapshot& snapshot, bool showsLights) {
  return showsLights ? shadowDefines(snapshot) + areaLightDefines(snapshot) : "#define NO_LIGHTS\n";
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

// Replaces the buffer's contents, and the buffer if `count`, the number of values in it, changes.
template <class T>
void write(const gl::Functions& gl, const std::vector<T>& values, std::size_t& count, gl::Buffer& buffer) {
  if (buffer.id() == 0 || count != values.size()) buffer = gl::Buffer(gl, values.size() * sizeof(T));
  count = values.size();
  buffer.write(0, gl::bytesOf(values));
}

}  // namespace

// Sets the state of draws, leaving what is set already.
class ScenePass::Binder {
 public:
  // Captures have reduced meshes and materials if the technique says so.
  Binder(const ScenePass& pass, const shading::View& view, bool isCapture = false)
      : pass_(pass),
        gl_(pass.gl_),
        view_(view),
        share_(isCapture ? pass.technique_.captureLod : 1.0f),
        isPlain_(isCapture && !pass.technique_.captureTextures),
        isCapture_(isCapture) {}

  bool isCapture() const { return isCapture_; }

  void bind(const Draw& draw, GLuint program) { bind(draw, program, pass_.facesOf(draw, view_)); }

  void bind(const Draw& draw, GLuint program, Faces faces) {
    if (program != program_) gl_.UseProgram(program_ = program);
    if (draw.mesh != mesh_) bindMesh(draw.mesh);
    if (draw.material != material_) bindMaterial(draw.material);
    setFacing(faces, frontFace(view_, pass_.snapshot_->instances[draw.instance].mirrored));
    pass_.instanceSlots_.bind(gpu::kInstanceBlock, draw.instance);
  }

 private:
  void bindMesh(const GpuMesh* mesh) {
    mesh_ = mesh;
    gl_.BindVertexArray(share_ < 1.0f ? mesh->simplified.at(share_).vertexArray.id() : mesh->vertexArray.id());
    gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kSmoothingGroupBlock, mesh->smoothingGroups.id());
  }

  void bindMaterial(int material) {
    material_ = material;
    if (isPlain_) return pass_.resources_->bindPlainMaterial(material);
    pass_.resources_->bindMaterial(material);
  }

  void setFacing(Faces faces, GLenum front) {
    if (front != front_) gl_.FrontFace(front_ = front);
    if (faces == faces_) return;
    faces_ = faces;
    if (faces == Faces::both) return gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_CULL_FACE);
    gl_.CullFace(faces == Faces::front ? GL_BACK : GL_FRONT);
  }

  const ScenePass& pass_;
  const gl::Functions& gl_;
  const shading::View& view_;
  const float share_;
  const bool isPlain_;
  const bool isCapture_;
  GLuint program_ = 0;
  const GpuMesh* mesh_ = nullptr;
  int material_ = -1;
  GLenum front_ = GL_NONE;
  Faces faces_ = Faces::both;  // as the pass leaves it
};

ScenePass::ScenePass(RasterDevice::Impl& device, const Technique& technique)
    : device_(device), gl_(device.context.functions()), technique_(technique), noVertices_(gl::makeVertexArray(gl_)) {}

void ScenePass::beginFrame(const Snapshot& snapshot, const std::vector<gpu::PassConstants>& passes,
                           const std::vector<int>& probeResolutions) {
  snapshot_ = &snapshot;
  const bool isNewScene = !resources_ || resources_->scene() != snapshot.scene;
  if (isNewScene) resources_ = device_.resourcesOf(snapshot.scene);
  resources_->showEnvironment(snapshot.environmentIndex);
  if (isNewScene || !drawsFit(snapshot, probeResolutions)) buildDraws(snapshot, probeResolutions);
  showShapes();
  reflections_.clear();
  for (const SnapshotInstance& instance : snapshot.instances)
    reflections_.push_back(reflectionOf(technique_, snapshot, instance));
  resources_->showScreens(snapshot.screens);
  if (!technique_.captureTextures) resources_->showPlainMaterials(snapshot.screens);
  uploadInstances();
  beginShadows();
  uploadLights();
  uploadPasses(passes);
  uploadProbes();
  resources_->bindScene();
  resources_->bindReflection(technique_);
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLightBlock, lights_.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kAreaLightBlock, areaLights_.id());
}

void ScenePass::beginShadows() {
  if (!castsShadows(*snapshot_)) return;
  if (!shadows_) shadows_.emplace(device_.context, device_.limits, technique_.shadowResolution);
  shadows_->beginFrame(*snapshot_);
  shadows_->bind();
}

// Sides that face the light are left out where the other side is not to be seen: rays to the light, too, pass through
// such surfaces from behind, and what is lit can't shadow itself.
void ScenePass::drawShadows(FrameCounters& counters) {
  if (!castsShadows(*snapshot_)) return;
  gl_.DepthFunc(GL_GREATER);
  gl_.Disable(GL_CULL_FACE);
  for (std::size_t f = 0; f < shadows_->faces().size(); ++f) {
    const gpu::ShadowFace& face = shadows_->faces()[f];
    const RenderTarget target = shadows_->target(f);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    gl_.Viewport(0, 0, target.widthPx, target.heightPx);
    gl_.Disable(GL_CULL_FACE);
    Binder binder(*this, face.view);
    for (const Draw* draw : shadowCasters(face)) {
      binder.bind(*draw, draw->shadow, draw->cullsBackFaces ? Faces::back : Faces::both);
      gl_.DrawElements(GL_TRIANGLES, draw->mesh->indexCount, GL_UNSIGNED_INT, nullptr);
      ++counters.draws;
      counters.triangles += draw->mesh->indexCount / 3;
    }
  }
}

std::vector<const ScenePass::Draw*> ScenePass::shadowCasters(const gpu::ShadowFace& face) const {
  const bool isParallel = face.values.x > 0.5f;  // sees the whole scene
  std::vector<const Draw*> casters;
  for (const Draw& draw : draws_)
    if (draw.mesh->indexCount > 0 &&
        (isParallel || !isOutsideFrustum(snapshot_->instances[draw.instance].worldBounds, face.view)))
      casters.push_back(&draw);
  return casters;
}

void ScenePass::draw(std::size_t pass, const RenderTarget& target, const ShownProbes& probes, FrameCounters& counters,
                     FacePart shownPart, LookupRecords* records) {
  beginPass(pass, target);
  const bool isCapture = probes.hidden != kNoProbe;
  const std::vector<const Draw*> visible = visibleDraws(pass, probes.hidden, shownPart);
  const auto firstBlended = std::ranges::find_if(visible, [](const Draw* draw) { return draw->isBlended(); });
  const int rows = rowsOf(shownPart, target.heightPx);
  if (shownPart != FacePart::whole) {
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(0, 0, target.widthPx, rows);
  }
  drawSurfaces({visible.begin(), firstBlended}, pass, probes, records);
  gl_.Disable(GL_SCISSOR_TEST);
  if (records != nullptr) records->keepMarks();
  drawBackground();
  counters.draws += static_cast<std::int64_t>(visible.size()) + 1;
  counters.triangles += 1;
  for (const Draw* draw : visible) {
    counters.triangles += indexCount(*draw, isCapture) / 3;
    for (const Draw* part : readBehind(*draw, pass)) {
      ++counters.draws;
      counters.triangles += indexCount(*part, isCapture) / 3;
    }
  }
  if (firstBlended == visible.end()) return;
  const std::vector<const Draw*> blended(firstBlended, visible.end());
  layers_->compose({target.framebuffer, target.widthPx, rows}, [&] { drawSurfaces(blended, pass, probes); });
  ++counters.draws;
  ++counters.triangles;
}

CaptureLookups ScenePass::lookupsOf(std::size_t pass, const ShownProbes& probes, FacePart shownPart) const {
  const gpu::PassConstants& constants = passes_[pass];
  CaptureLookups lookups;
  lookups.areas.assign(snapshot_->probes.size(), {});
  bool isBlended = false;
  for (const Draw* draw : visibleDraws(pass, probes.hidden, shownPart)) {
    isBlended = isBlended || draw->isBlended();
    const int probe = reflections_[draw->instance].probe;
    const bool showsTwo = draw->showingBlend != 0;
    if (draw->showingProbe == 0 || (probe == probes.hidden && !showsTwo)) continue;
    const TexelRect area = texelsShowing(snapshot_->instances[draw->instance].worldBounds, constants.view,
                                         static_cast<int>(constants.image.x));
    const auto lookedUp = static_cast<std::size_t>(probe);
    lookups.any = true;
    lookups.areShown = lookups.areShown && probes.shown[lookedUp];
    lookups.isRecordable = lookups.isRecordable && draw->captured.recordingProbe != 0 && !showsTwo;
    lookups.areas[lookedUp] = joined(lookups.areas[lookedUp], area);
  }
  // What shines through layers is not what the list of texels says.
  lookups.isRecordable = lookups.isRecordable && lookups.any && !isBlended;
  return lookups;
}

// The surfaces that a pass draws, in order.
std::vector<const ScenePass::Draw*> ScenePass::visibleDraws(std::size_t pass, int hiddenProbe, FacePart part) const {
  std::vector<const Draw*> visible;
  for (const Draw& draw : draws_) {
    const int probe = snapshot_->instances[draw.instance].probe;
    const bool isHidden = probe != kNoProbe && probe == hiddenProbe && !draw.isCapturedFromInside;
    const bool isOutside =
        isOutsidePart(snapshot_->instances[draw.instance].worldBounds, glm::vec3(passes_[pass].view.origin), part);
    if (!isHidden && !isOutside && isVisible(draw, pass)) visible.push_back(&draw);
  }
  return visible;
}

void ScenePass::drawSurfaces(const std::vector<const Draw*>& draws, std::size_t pass, const ShownProbes& probes,
                             const LookupRecords* records) {
  const bool clips = isClipped(passes_[pass]);
  gl_.Disable(GL_CULL_FACE);
  if (clips) gl_.Enable(GL_CLIP_DISTANCE0);
  const bool isCapture = probes.hidden != kNoProbe;
  Binder binder(*this, passes_[pass].view, isCapture);
  for (const Draw* draw : draws) {
    const bool isCaptured = isCapture && snapshot_->instances[draw->instance].probe == probes.hidden;
    GLuint program = bindReflection(*draw, probes);
    if (draw->backFaces != 0) drawBackFaces(*draw, pass, binder);
    if (records != nullptr) program = markDraw(*draw, program, probes, *records);
    binder.bind(*draw, program, isCaptured ? Faces::back : facesOf(*draw, passes_[pass].view));
    drawTriangles(*draw, isCapture);
  }
  if (clips) gl_.Disable(GL_CLIP_DISTANCE0);  // other programs have no such distance
  if (!technique_.seamless) gl_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

// Returns the program that writes what `program` does and tells the records of it.
GLuint ScenePass::markDraw(const Draw& draw, GLuint program, const ShownProbes& probes,
                           const LookupRecords& records) const {
  if (draw.captured.recordingProbe != 0 && program == draw.captured.showingProbe) {
    const int lookedUp = reflections_[draw.instance].probe;
    records.markDraw(draw.captured.recordingProbe, lookedUp, (*probes.states)[static_cast<std::size_t>(lookedUp)]);
    return draw.captured.recordingProbe;
  }
  if (draw.captured.hidingLookups != 0) {
    records.hideMarks();
    return draw.captured.hidingLookups;
  }
  records.keepMarks();
  return program;
}

// Binds what the draw's specular lobe looks up, and returns the program that does. A map may not be read while it is
// captured: by its owners, captured from inside, nor by what it is nearest to.
GLuint ScenePass::bindReflection(const Draw& draw, const ShownProbes& probes) const {
  const Reflection& reflection = reflections_[draw.instance];
  if (!technique_.seamless) gl_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  const auto isShown = [&](int probe) {
    return probe != kNoProbe && probe != probes.hidden && probes.shown[static_cast<std::size_t>(probe)];
  };
  if (probes.mirroredViews != nullptr && (*probes.mirroredViews)[draw.instance] != 0) {
    gl_.BindTextureUnit(gpu::kPlanarUnit, (*probes.mirroredViews)[draw.instance]);
    if (draw.showingProbe != 0 && isShown(reflection.probe)) bindProbe(*probes.maps, reflection.probe);
    return draw.showingMirroredView;
  }
  const bool showsFirst = draw.showingProbe != 0 && isShown(reflection.probe);
  const bool showsSecond = draw.showingBlend != 0 && isShown(reflection.second);
  const bool isCapture = probes.hidden != kNoProbe;
  if (!showsFirst && !showsSecond) return isCapture ? draw.captured.showingEnvironment : draw.showingEnvironment;
  bindProbe(*probes.maps, showsFirst ? reflection.probe : reflection.second);
  if (!showsFirst || !showsSecond) return isCapture ? draw.captured.showingProbe : draw.showingProbe;
  probes.maps->bindSecond(reflection.second);
  if (probeSlots_.size() > 0) probeSlots_.bind(gpu::kSecondProbeBlock, static_cast<std::size_t>(reflection.second));
  return isCapture ? draw.captured.showingBlend : draw.showingBlend;
}

void ScenePass::bindProbe(const ProbeMaps& maps, int probe) const {
  maps.bind(probe);
  // Of all cube maps that a draw reads; those that read probes read no others.
  if (!technique_.seamless) gl_.Disable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  if (probeSlots_.size() > 0) probeSlots_.bind(gpu::kProbeBlock, static_cast<std::size_t>(probe));
}

// The surfaces whose back faces the draw's fragments read: all of the object that it is a part of, and of nothing else,
// so that no object sees another's.
std::vector<const ScenePass::Draw*> ScenePass::readBehind(const Draw& draw, std::size_t pass) const {
  const std::vector<Instance>& instances = snapshot_->scene->instances;
  const auto nodeOf = [&](const Draw& d) {
    return instances[static_cast<std::size_t>(snapshot_->instances[d.instance].source)].node;
  };
  std::vector<const Draw*> parts;
  if (draw.backFaces == 0) return parts;
  for (const Draw& part : draws_)
    if (part.backFaces != 0 && nodeOf(part) == nodeOf(draw) && isVisible(part, pass)) parts.push_back(&part);
  return parts;
}

void ScenePass::drawBackFaces(const Draw& draw, std::size_t pass, Binder& binder) {
  const glm::vec4& samples = passes_[pass].image;
  const BackFaces::Drawing drawing = backFaces_->beginDraws(static_cast<int>(samples.x), static_cast<int>(samples.y));
  const bool clips = isClipped(passes_[pass]);
  if (clips) gl_.Disable(GL_CLIP_DISTANCE0);  // a way inside may end behind the plane
  for (const Draw* part : readBehind(draw, pass)) {
    binder.bind(*part, binder.isCapture() ? part->captured.backFaces : part->backFaces, Faces::back);
    drawTriangles(*part, binder.isCapture());
  }
  if (clips) gl_.Enable(GL_CLIP_DISTANCE0);
}

// Closed glass is drawn without its back faces as long as they can't be seen.
ScenePass::Faces ScenePass::facesOf(const Draw& draw, const shading::View& view) const {
  const bool showsFrontOnly =
      draw.cullsBackFaces ||
      (draw.isClosedGlass && isViewedFromOutside(snapshot_->instances[draw.instance].worldBounds, view));
  return showsFrontOnly ? Faces::front : Faces::both;
}

void ScenePass::drawIds(std::size_t pass, const RenderTarget& target) {
  constexpr std::array<GLuint, 4> kNothing{};
  gl_.ClearNamedFramebufferuiv(target.framebuffer, GL_COLOR, 0, kNothing.data());
  beginPass(pass, target);
  Binder binder(*this, passes_[pass].view);
  for (const Draw& draw : draws_) {
    if (!isVisible(draw, pass)) continue;
    binder.bind(draw, device_.programs.ids(draw.variant));
    gl_.DrawElements(GL_TRIANGLES, draw.mesh->indexCount, GL_UNSIGNED_INT, nullptr);
  }
}

// A deforming instance keeps its draw whatever its shape: topology is the same.
bool ScenePass::drawsFit(const Snapshot& snapshot, const std::vector<int>& probeResolutions) const {
  if (drawnEnvironment_ != snapshot.environmentIndex || drawnResolutions_ != probeResolutions) return false;
  return draws_.size() == snapshot.instances.size() && std::ranges::all_of(draws_, [&](const Draw& draw) {
           const SnapshotInstance& instance = snapshot.instances[draw.instance];
           const bool deforms = draw.source->isDeformed && instance.mesh->isDeformed;
           return (draw.source == instance.mesh || deforms) && draw.material == instance.material;
         });
}

void ScenePass::showShapes() {
  for (const Draw& draw : draws_)
    if (const auto& mesh = snapshot_->instances[draw.instance].mesh; mesh->isDeformed)
      resources_->mesh(draw.instance, mesh, meshNeeds(snapshot_->instances[draw.instance], draw.backFaces != 0));
}

MeshNeeds ScenePass::meshNeeds(const SnapshotInstance& instance, bool hasBackFaces) const {
  const std::vector<Instance>& instances = snapshot_->scene->instances;
  return {.inwardDistances = hasBackFaces,
          .share = technique_.captureLod,
          .rest = instances[static_cast<std::size_t>(instance.source)].mesh.get()};
}

GLsizei ScenePass::indexCount(const Draw& draw, bool isCapture) const {
  const bool isReduced = isCapture && technique_.captureLod < 1.0f;
  return isReduced ? draw.mesh->simplified.at(technique_.captureLod).indexCount : draw.mesh->indexCount;
}

void ScenePass::drawTriangles(const Draw& draw, bool isCapture) const {
  gl_.DrawElements(GL_TRIANGLES, indexCount(draw, isCapture), GL_UNSIGNED_INT, nullptr);
}

// Blended surfaces last, then sorted by what is dear to change. Nothing here may depend on addresses or GL names: the
// order decides which of two coinciding surfaces is seen, and how many fragments pass.
void ScenePass::buildDraws(const Snapshot& snapshot, const std::vector<int>& probeResolutions) {
  const int environmentSize = resources_->filterEnvironment(technique_.filter, device_.programs);
  const std::string settings = techniqueDefines(technique_) + clipDefines(technique_);
  const std::string lights = lightDefines(snapshot, true);
  const std::string capturedLights = lightDefines(snapshot, technique_.captureLights);
  const std::string environmentLevels = filterDefines(technique_.filter, environmentSize);
  const Lookup& lookup = lookupOf(technique_.lookup);
  const std::string mapLookup = lookup.defines(technique_.lookup) + mapDefines(technique_, snapshot);
  const EnvironmentSource source = environmentSource(snapshot.environment(), technique_.textureFilter);
  background_ = device_.programs.background(source);
  drawnEnvironment_ = snapshot.environmentIndex;
  drawnResolutions_ = probeResolutions;
  draws_.clear();
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    const SnapshotInstance& instance = snapshot.instances[i];
    const Material& material = snapshot.materialOf(instance);
    const SurfaceVariant variant = variantOf(snapshot, instance);
    const std::string ofMaterial = settings + refractionDefines(technique_, material) + conductorDefines(material);
    const std::string defines = ofMaterial + lights;
    const bool hasBackFaces = readsBackFaces(technique_, material);
    const Reflection reflection = reflectionOf(technique_, snapshot, instance);
    const bool hasProbe = reflection.source == ReflectionSource::probe;
    // Levels of a second probe are read as those of the first.
    const int resolution =
        hasProbe ? probeResolutions[static_cast<std::size_t>(reflection.probe)] : technique_.resolution;
    const std::string lookupDefines = filterDefines(mapFilter(technique_), resolution) + mapLookup;
    draws_.push_back(
        {.variant = variant,
         .material = instance.material,
         .instance = i,
         .source = instance.mesh,
         .mesh = &resources_->mesh(i, instance.mesh, meshNeeds(instance, hasBackFaces)),
         .showingEnvironment = device_.programs.surfaceShowingEnvironment(variant, source, defines + environmentLevels),
         .showingProbe = hasProbe ? device_.programs.surfaceShowingProbe(variant, defines + lookupDefines) : 0,
         .showingBlend = reflection.second != kNoProbe
                             ? device_.programs.surfaceShowingProbe(variant, defines + lookupDefines + kBlendDefines)
                             : 0,
         .showingMirroredView =
             !(lookup.isPlanar && instance.probe >= 0) ? 0
             : transmits(material)
                 ? device_.programs.surfaceShowingProbe(variant, defines + lookupDefines + kPlanarDefines)
                 : device_.programs.surfaceShowingEnvironment(variant, source,
                                                              defines + environmentLevels + kPlanarDefines),
         .cullsBackFaces = cullsBackFaces(material),
         .isClosedGlass = isSolidGlass(material) && !material.doubleSided && isClosed(*instance.mesh),
         .isCapturedFromInside = isCapturedFromInside(technique_, material),
         .backFaces = hasBackFaces ? device_.programs.backFaces(variant) : 0,
         .shadow = castsShadows(snapshot) ? device_.programs.shadow(variant) : 0,
         .captured = {}});
    Draw& draw = draws_.back();
    const SurfaceVariant captured = technique_.captureTextures ? variant : plainVariant(variant, *instance.mesh);
    const std::string capturedDefines = ofMaterial + capturedLights;
    draw.captured.showingEnvironment =
        device_.programs.surfaceShowingEnvironment(captured, source, capturedDefines + environmentLevels);
    if (draw.showingProbe != 0)
      draw.captured.showingProbe = device_.programs.surfaceShowingProbe(captured, capturedDefines + lookupDefines);
    if (draw.showingBlend != 0)
      draw.captured.showingBlend =
          device_.programs.surfaceShowingProbe(captured, capturedDefines + lookupDefines + kBlendDefines);
    if (hasProbe && repeatsLookups(technique_) && hasOneLookup(variant))
      draw.captured.recordingProbe = device_.programs.surfaceRecordingLookup(captured, capturedDefines + lookupDefines);
    if (repeatsLookups(technique_) && mayCoverLookups(variant))
      draw.captured.hidingLookups =
          device_.programs.surfaceHidingLookup(captured, source, capturedDefines + environmentLevels);
    if (hasBackFaces) draw.captured.backFaces = device_.programs.backFaces(captured);
    if (hasBackFaces && !backFaces_) backFaces_.emplace(device_.context, device_.limits);
  }
  std::ranges::sort(draws_, {},
                    [](const Draw& d) { return std::tuple(d.isBlended(), d.variant, d.material, d.instance); });
  if (!layers_ && !draws_.empty() && draws_.back().isBlended())
    layers_.emplace(device_.context, device_.programs.composeLayers());
  device_.context.check("uploading a scene's meshes");
}

SurfaceVariant ScenePass::variantOf(const Snapshot& snapshot, const SnapshotInstance& instance) const {
  SurfaceVariant variant = resources_->variantOf(instance.material, *instance.mesh, technique_.textureFilter);
  variant.reflects = reflectionOf(technique_, snapshot, instance).source != ReflectionSource::nothing;
  if (lookupOf(technique_.lookup).isSingleView && !instance.mesh->uvs[0].empty()) variant.attributes = true;
  return variant;
}

void ScenePass::uploadInstances() {
  const std::vector<SnapshotInstance>& instances = snapshot_->instances;
  if (instanceSlots_.size() != instances.size())
    instanceSlots_ = UniformSlots<gpu::InstanceConstants>(device_.context, instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) instanceSlots_.set(i, constantsOf(instances[i], reflections_[i]));
  instanceSlots_.upload();
}

void ScenePass::uploadLights() {
  write(gl_, castsShadows(*snapshot_) ? shadows_->lights() : snapshot_->lights, lightCount_, lights_);
  write(gl_, snapshot_->areaLights, areaLightCount_, areaLights_);
}

void ScenePass::uploadProbes() {
  const std::vector<Probe>& probes = snapshot_->probes;
  if (!lookupOf(technique_.lookup).readsProbe || probes.empty()) return;
  if (probeSlots_.size() != probes.size())
    probeSlots_ = UniformSlots<gpu::ProbeConstants>(device_.context, probes.size());
  for (std::size_t i = 0; i < probes.size(); ++i) probeSlots_.set(i, probeConstants(*snapshot_, probes[i]));
  probeSlots_.upload();
}

void ScenePass::uploadPasses(const std::vector<gpu::PassConstants>& passes) {
  passes_ = passes;
  if (passSlots_.size() < passes.size()) passSlots_ = UniformSlots<gpu::PassConstants>(device_.context, passes.size());
  for (std::size_t i = 0; i < passes.size(); ++i) passSlots_.set(i, passes[i]);
  passSlots_.upload();
}

void ScenePass::beginPass(std::size_t pass, const RenderTarget& target) const {
  constexpr float kFarthest = 0.0f;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.widthPx, target.heightPx);
  gl_.ClearNamedFramebufferfv(target.framebuffer, GL_DEPTH, 0, &kFarthest);
  gl_.DepthFunc(GL_GREATER);
  gl_.Disable(GL_CULL_FACE);
  passSlots_.bind(gpu::kPassBlock, pass);
}

bool ScenePass::isVisible(const Draw& draw, std::size_t pass) const {
  const Bounds& bounds = snapshot_->instances[draw.instance].worldBounds;
  return draw.mesh->indexCount > 0 && !isOutsideFrustum(bounds, passes_[pass].view) &&
         !isClippedAway(bounds, passes_[pass]);
}

// Last, where nothing was drawn: no colour needs clearing and hidden sky costs nothing.
void ScenePass::drawBackground() const {
  gl_.DepthFunc(GL_GEQUAL);
  gl_.Disable(GL_CULL_FACE);
  gl_.UseProgram(background_);
  gl_.BindVertexArray(noVertices_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace pb
