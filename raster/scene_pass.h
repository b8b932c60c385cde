// Draws a snapshot from one view into one target: what captures and the final image have in common.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "raster/back_faces.h"
#include "raster/captured_faces.h"
#include "raster/device.h"
#include "raster/draw_binder.h"
#include "raster/frame_constants.h"
#include "raster/lookup_records.h"
#include "raster/reflection.h"
#include "raster/render_target.h"
#include "raster/scene_draws.h"
#include "raster/shadow_maps.h"
#include "raster/transparency.h"
#include "raster/triangle_lists.h"

namespace pb {

inline constexpr int kNoProbe = -1;

class ProbeMaps;

// What a pass sees of the probes.
struct ShownProbes {
  const ProbeMaps* maps;                               // may be null if none is shown
  const std::vector<bool>& shown;                      // by probe: its map, not the environment
  int hidden = kNoProbe;                               // the probe that is captured: its owners are left out
  const std::vector<GLuint>* mirroredViews = nullptr;  // by instance: the texture of the mirrored view that a flat
                                                       // reflector shows, 0 for none; null if nothing shows one
  const std::vector<MapState>* states = nullptr;       // by probe; for records only

  bool isCapture() const { return hidden != kNoProbe; }
};

class ScenePass {
 public:
  ScenePass(RasterDevice::Impl& device, const Technique& technique);

  // Uploads what changes from frame to frame: transforms, lights and the views of the frame's passes.
  void beginFrame(const Snapshot& snapshot, const std::vector<gpu::PassConstants>& passes,
                  const std::vector<int>& probeResolutions);

  // The frame's shadow maps, before what shows them.
  void drawShadows(FrameCounters& counters);

  // The frame's pass number `pass`, surfaces in a part of it only. Probes that are not shown, and the hidden one, show
  // the environment. `records`, if given, hears of every surface that looks up a probe's map: all of them have to be
  // recordable.
  void draw(std::size_t pass, const RenderTarget& target, const ShownProbes& probes, FrameCounters& counters,
            FacePart shownPart = FacePart::whole, LookupRecords* records = nullptr);

  // Of this frame, of techniques that repeat lookups: by number what captures may look up.
  const std::vector<LookupGroup>& lookupGroups() const { return lookupGroups_; }
  void bindMirror(const LookupGroup& group) const { resources_->bindMaterial(group.mirror); }

  // What later bounce iterations change of the capture that draw() makes.
  CaptureLookups lookupsOf(std::size_t pass, const ShownProbes& probes, FacePart shownPart) const;

  // The same objects into an RGBA32UI target: SampleId, 0.
  void drawIds(std::size_t pass, const RenderTarget& target);

 private:
  using Draws = std::vector<const SurfaceDraw*>;

  void beginShadows();
  void groupLookups();
  Draws shadowCasters(const gpu::ShadowFace& face) const;
  void beginPass(std::size_t pass, const RenderTarget& target) const;
  bool isVisible(const SurfaceDraw& draw, std::size_t pass) const;
  Draws visibleDraws(std::size_t pass, int hiddenProbe, FacePart part) const;
  DrawBinder binderFor(const shading::View& view, bool isCapture = false) const;
  void drawSurfaces(const Draws& draws, std::size_t pass, const ShownProbes& probes,
                    const LookupRecords* records = nullptr);
  GLuint markDraw(const SurfaceDraw& draw, GLuint program, const ShownProbes& probes,
                  const LookupRecords& records) const;
  GLuint bindReflection(const SurfaceDraw& draw, const ShownProbes& probes) const;
  void bindProbe(const ProbeMaps& maps, int probe) const;
  Draws readBehind(const SurfaceDraw& draw, std::size_t pass) const;
  void drawBackFaces(const SurfaceDraw& draw, std::size_t pass, bool isCapture, DrawBinder& binder);
  void drawBackground() const;

  RasterDevice::Impl& device_;
  const gl::Functions& gl_;
  Technique technique_;
  std::shared_ptr<SceneResources> resources_;
  SceneDraws draws_;
  FrameConstants constants_;
  std::vector<Reflection> reflections_;  // by instance
  std::vector<LookupGroup> lookupGroups_;
  std::vector<int> lookupGroupOf_;  // by instance; -1: none
  gl::VertexArray noVertices_;
  const Snapshot* snapshot_ = nullptr;       // between beginFrame() and the last pass of the frame
  std::optional<BackFaces> backFaces_;       // of scenes whose refraction reads them
  std::optional<TransparentLayers> layers_;  // of scenes with blended surfaces
  std::optional<ShadowMaps> shadows_;        // of scenes that cast shadows
  TriangleLists triangleLists_;
};

}  // namespace pb
