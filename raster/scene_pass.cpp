#include "raster/scene_pass.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "raster/culling.h"
#include "raster/lookup.h"
#include "raster/planar.h"
#include "raster/probe_maps.h"

namespace pb {
namespace {

bool isClipped(const gpu::PassConstants& pass) { return glm::vec3(pass.clip) != glm::vec3(0.0f); }

// Whatever lies in the plane of a mirrored view counts as behind it: the reflector would hide what it reflects.
bool isClippedAway(const Bounds& box, const gpu::PassConstants& pass) {
  const float size = glm::length(box.extent());
  return isClipped(pass) && isBehindPlane(box, glm::vec3(pass.clip), pass.clip.w - kPlanarThickness * size);
}

}  // namespace

ScenePass::ScenePass(RasterDevice::Impl& device, const Technique& technique)
    : device_(device),
      gl_(device.context.functions()),
      technique_(technique),
      draws_(device, technique_),
      constants_(device.context),
      noVertices_(gl::makeVertexArray(gl_)),
      triangleLists_(gl_) {}

void ScenePass::beginFrame(const Snapshot& snapshot, const std::vector<gpu::PassConstants>& passes,
                           const std::vector<int>& probeResolutions) {
  snapshot_ = &snapshot;
  const bool isNewScene = !resources_ || resources_->scene() != snapshot.scene;
  if (isNewScene) resources_ = device_.resourcesOf(snapshot.scene);
  resources_->showEnvironment(snapshot.environmentIndex);
  draws_.show(snapshot, *resources_, probeResolutions, isNewScene);
  if (!backFaces_ && draws_.haveBackFaces()) backFaces_.emplace(device_.context, device_.limits);
  if (!layers_ && draws_.haveBlended()) layers_.emplace(device_.context, device_.programs.composeLayers());
  reflections_.clear();
  for (const SnapshotInstance& instance : snapshot.instances)
    reflections_.push_back(reflectionOf(technique_, snapshot, instance));
  groupLookups();
  resources_->showScreens(snapshot.screens);
  if (!technique_.captureTextures) resources_->showPlainMaterials(snapshot.screens);
  constants_.uploadInstances(snapshot.instances, reflections_);
  beginShadows();
  constants_.uploadLights(castsShadows(snapshot) ? shadows_->lights() : snapshot.lights, snapshot.areaLights);
  constants_.uploadPasses(passes);
  triangleLists_.beginFrame(passes);
  if (readsProbe(technique_)) constants_.uploadProbes(snapshot);
  resources_->bindScene();
  resources_->bindReflection(technique_);
  constants_.bindLights();
}

void ScenePass::groupLookups() {
  lookupGroups_.clear();
  lookupGroupOf_.assign(reflections_.size(), -1);
  for (const SurfaceDraw& draw : draws_.all()) {
    if (draw.captured.recordingProbe == 0) continue;
    const bool isMirror = draw.captured.record == LookupRecord::mirror;
    const LookupGroup group = {reflections_[draw.instance].probe, isMirror ? draw.material : LookupGroup::kNoMirror};
    const auto found = std::ranges::find(lookupGroups_, group);
    lookupGroupOf_[draw.instance] = static_cast<int>(found - lookupGroups_.begin());
    if (found == lookupGroups_.end()) lookupGroups_.push_back(group);
  }
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
    DrawBinder binder = binderFor(face.view);
    for (const SurfaceDraw* draw : shadowCasters(face)) {
      binder.draw(*draw, draw->shadow, draw->cullsBackFaces ? Sides::back : Sides::both);
      ++counters.draws;
      counters.triangles += draw->mesh->indexCount / 3;
    }
  }
}

ScenePass::Draws ScenePass::shadowCasters(const gpu::ShadowFace& face) const {
  const bool isParallel = face.values.x > 0.5f;  // sees the whole scene
  Draws casters;
  for (const SurfaceDraw& draw : draws_.all())
    if (draw.mesh->indexCount > 0 &&
        (isParallel || !isOutsideFrustum(snapshot_->instances[draw.instance].worldBounds, face.view)))
      casters.push_back(&draw);
  return casters;
}

void ScenePass::draw(std::size_t pass, const RenderTarget& target, const ShownProbes& probes, FrameCounters& counters,
                     FacePart shownPart, LookupRecords* records) {
  beginPass(pass, target);
  const float share = probes.isCapture() ? technique_.captureLod : 1.0f;
  Draws visible = visibleDraws(pass, probes.hidden, shownPart);
  if (const std::size_t repeated = device_.fault.repeatedDraws(visible.size()); repeated > 0)
    visible.insert(visible.begin(), repeated, visible.front());
  const auto firstBlended = std::ranges::find_if(visible, [](const SurfaceDraw* draw) { return draw->isBlended(); });
  const int rows = rowsOf(shownPart, target.heightPx);
  if (shownPart != FacePart::whole) {
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(0, 0, target.widthPx, rows);
  }
  drawSurfaces({visible.begin(), firstBlended}, pass, probes, records);
  gl_.Disable(GL_SCISSOR_TEST);
  if (records != nullptr) records->skipDraw();
  drawBackground();
  counters.draws += static_cast<std::int64_t>(visible.size()) + 1;
  counters.triangles += 1;
  for (const SurfaceDraw* draw : visible) {
    counters.triangles += draw->indexCount(share) / 3;
    for (const SurfaceDraw* part : readBehind(*draw, pass)) {
      ++counters.draws;
      counters.triangles += part->indexCount(share) / 3;
    }
  }
  if (firstBlended == visible.end()) return;
  const Draws blended(firstBlended, visible.end());
  layers_->compose({target.framebuffer, target.widthPx, rows}, [&] { drawSurfaces(blended, pass, probes); });
  ++counters.draws;
  ++counters.triangles;
}

CaptureLookups ScenePass::lookupsOf(std::size_t pass, const ShownProbes& probes, FacePart shownPart) const {
  const gpu::PassConstants& constants = constants_.pass(pass);
  CaptureLookups lookups;
  lookups.areas.assign(lookupGroups_.size(), {});
  bool isBlended = false;
  for (const SurfaceDraw* draw : visibleDraws(pass, probes.hidden, shownPart)) {
    isBlended = isBlended || draw->isBlended();
    const int probe = reflections_[draw->instance].probe;
    const bool showsTwo = draw->shown.showingBlend != 0;
    if (draw->shown.showingProbe == 0 || (probe == probes.hidden && !showsTwo)) continue;
    const int group = lookupGroupOf_[draw->instance];
    lookups.any = true;
    lookups.areShown = lookups.areShown && probes.shown[static_cast<std::size_t>(probe)];
    lookups.isRecordable = lookups.isRecordable && group >= 0 && !showsTwo;
    if (!lookups.isRecordable) continue;
    TexelRect& area = lookups.areas[static_cast<std::size_t>(group)];
    const SnapshotInstance& instance = snapshot_->instances[draw->instance];
    const Ball ball = transformed(Ball{instance.mesh->bounds.centre(), draw->mesh->radius}, instance.worldFromObject);
    const int size = static_cast<int>(constants.image.x);
    area = joined(area, common(texelsShowing(instance.worldBounds, constants.view, size),
                               texelsShowing(ball, constants.view, size)));
  }
  // What shines through layers is not what the list of texels says.
  lookups.isRecordable = lookups.isRecordable && lookups.any && !isBlended;
  return lookups;
}

// The surfaces that a pass draws, in order.
ScenePass::Draws ScenePass::visibleDraws(std::size_t pass, int hiddenProbe, FacePart part) const {
  hiddenProbe = device_.fault.hiddenProbe(hiddenProbe, snapshot_->probes.size());
  Draws visible;
  for (const SurfaceDraw& draw : draws_.all()) {
    const int probe = snapshot_->instances[draw.instance].probe;
    const bool isHidden = probe != kNoProbe && probe == hiddenProbe && !draw.isCapturedFromInside;
    const bool isOutside = isOutsidePart(snapshot_->instances[draw.instance].worldBounds,
                                         glm::vec3(constants_.pass(pass).view.origin), part);
    if (!isHidden && !isOutside && isVisible(draw, pass)) visible.push_back(&draw);
  }
  return visible;
}

DrawBinder ScenePass::binderFor(const shading::View& view, bool isCapture) const {
  const DrawBinder::Frame frame = {gl_, *resources_, *snapshot_, constants_.instances()};
  if (!isCapture) return {frame, view, {.share = 1.0f, .isPlain = false}};
  return {frame, view, {.share = technique_.captureLod, .isPlain = !technique_.captureTextures}};
}

void ScenePass::drawSurfaces(const Draws& draws, std::size_t pass, const ShownProbes& probes,
                             const LookupRecords* records) {
  const bool clips = isClipped(constants_.pass(pass));
  gl_.Disable(GL_CULL_FACE);
  if (clips) gl_.Enable(GL_CLIP_DISTANCE0);
  DrawBinder binder = binderFor(constants_.pass(pass).view, probes.isCapture());
  const float share = probes.isCapture() ? technique_.captureLod : 1.0f;
  for (const SurfaceDraw* draw : draws) {
    const bool isCaptured = probes.isCapture() && snapshot_->instances[draw->instance].probe == probes.hidden;
    const Sides sides = isCaptured ? Sides::back : sidesOf(*draw, *snapshot_, constants_.pass(pass).view);
    const IndexRange range = triangleLists_.visible(pass, *draw, snapshot_->instances[draw->instance], share, sides);
    if (range.count == 0) continue;
    GLuint program = bindReflection(*draw, probes);
    if (draw->shown.backFaces != 0) drawBackFaces(*draw, pass, probes.isCapture(), binder);
    if (records != nullptr) program = markDraw(*draw, program, probes, *records);
    binder.draw(*draw, program, sides, range);
  }
  if (clips) gl_.Disable(GL_CLIP_DISTANCE0);  // other programs have no such distance
  if (!technique_.seamless) gl_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

// Returns the program that writes what `program` does and tells the records of it.
GLuint ScenePass::markDraw(const SurfaceDraw& draw, GLuint program, const ShownProbes& probes,
                           const LookupRecords& records) const {
  if (draw.captured.recordingProbe == 0 || program != draw.captured.showingProbe) {
    records.skipDraw();
    return program;
  }
  const int probe = reflections_[draw.instance].probe;
  records.markDraw(draw.captured.recordingProbe, lookupGroupOf_[draw.instance],
                   (*probes.states)[static_cast<std::size_t>(probe)]);
  return draw.captured.recordingProbe;
}

// Binds what the draw's specular lobe looks up, and returns the program that does. A map may not be read while it is
// captured: by its owners, captured from inside, nor by what it is nearest to.
GLuint ScenePass::bindReflection(const SurfaceDraw& draw, const ShownProbes& probes) const {
  const Reflection& reflection = reflections_[draw.instance];
  if (!technique_.seamless) gl_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  const auto isShown = [&](int probe) {
    return probe != kNoProbe && probe != probes.hidden && probes.shown[static_cast<std::size_t>(probe)];
  };
  if (probes.mirroredViews != nullptr && (*probes.mirroredViews)[draw.instance] != 0) {
    gl_.BindTextureUnit(gpu::kPlanarUnit, (*probes.mirroredViews)[draw.instance]);
    if (draw.shown.showingProbe != 0 && isShown(reflection.probe)) bindProbe(*probes.maps, reflection.probe);
    return draw.showingMirroredView;
  }
  const SurfaceDraw::Shown& programs = probes.isCapture() ? draw.captured : draw.shown;
  const bool showsFirst = programs.showingProbe != 0 && isShown(reflection.probe);
  const bool showsSecond = programs.showingBlend != 0 && isShown(reflection.second);
  if (!showsFirst && !showsSecond) return programs.showingEnvironment;
  bindProbe(*probes.maps, showsFirst ? reflection.probe : reflection.second);
  if (!showsFirst || !showsSecond) return programs.showingProbe;
  probes.maps->bindSecond(reflection.second);
  constants_.bindProbe(gpu::kSecondProbeBlock, reflection.second);
  return programs.showingBlend;
}

void ScenePass::bindProbe(const ProbeMaps& maps, int probe) const {
  maps.bind(probe);
  // Of all cube maps that a draw reads; those that read probes read no others.
  if (!technique_.seamless) gl_.Disable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  constants_.bindProbe(gpu::kProbeBlock, probe);
}

// The surfaces whose back faces the draw's fragments read: all of the object that it is a part of, and of nothing else,
// so that no object sees another's.
ScenePass::Draws ScenePass::readBehind(const SurfaceDraw& draw, std::size_t pass) const {
  const std::vector<Instance>& instances = snapshot_->scene->instances;
  const auto nodeOf = [&](const SurfaceDraw& d) {
    return instances[static_cast<std::size_t>(snapshot_->instances[d.instance].source)].node;
  };
  Draws parts;
  if (draw.shown.backFaces == 0) return parts;
  for (const SurfaceDraw& part : draws_.all())
    if (part.shown.backFaces != 0 && nodeOf(part) == nodeOf(draw) && isVisible(part, pass)) parts.push_back(&part);
  return parts;
}

void ScenePass::drawBackFaces(const SurfaceDraw& draw, std::size_t pass, bool isCapture, DrawBinder& binder) {
  const glm::vec4& samples = constants_.pass(pass).image;
  const BackFaces::Drawing drawing = backFaces_->beginDraws(static_cast<int>(samples.x), static_cast<int>(samples.y));
  const bool clips = isClipped(constants_.pass(pass));
  if (clips) gl_.Disable(GL_CLIP_DISTANCE0);  // a way inside may end behind the plane
  for (const SurfaceDraw* part : readBehind(draw, pass))
    binder.draw(*part, isCapture ? part->captured.backFaces : part->shown.backFaces, Sides::back);
  if (clips) gl_.Enable(GL_CLIP_DISTANCE0);
}

void ScenePass::drawIds(std::size_t pass, const RenderTarget& target) {
  constexpr std::array<GLuint, 4> kNothing{};
  gl_.ClearNamedFramebufferuiv(target.framebuffer, GL_COLOR, 0, kNothing.data());
  beginPass(pass, target);
  DrawBinder binder = binderFor(constants_.pass(pass).view);
  for (const SurfaceDraw& draw : draws_.all())
    if (isVisible(draw, pass)) binder.draw(draw, device_.programs.ids(draw.variant));
}

void ScenePass::beginPass(std::size_t pass, const RenderTarget& target) const {
  constexpr float kFarthest = 0.0f;
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.widthPx, target.heightPx);
  gl_.ClearNamedFramebufferfv(target.framebuffer, GL_DEPTH, 0, &kFarthest);
  gl_.DepthFunc(GL_GREATER);
  gl_.Disable(GL_CULL_FACE);
  constants_.bindPass(pass);
}

bool ScenePass::isVisible(const SurfaceDraw& draw, std::size_t pass) const {
  const Bounds& bounds = snapshot_->instances[draw.instance].worldBounds;
  return draw.mesh->indexCount > 0 && !isOutsideFrustum(bounds, constants_.pass(pass).view) &&
         !isClippedAway(bounds, constants_.pass(pass));
}

// Last, where nothing was drawn: no colour needs clearing and hidden sky costs nothing.
void ScenePass::drawBackground() const {
  gl_.DepthFunc(GL_GEQUAL);
  gl_.Disable(GL_CULL_FACE);
  gl_.UseProgram(draws_.background());
  gl_.BindVertexArray(noVertices_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace pb
