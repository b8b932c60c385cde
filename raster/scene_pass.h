// Draws a snapshot from one view into one target: what captures and the final image have in common.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "raster/back_faces.h"
#include "raster/captured_faces.h"
#include "raster/device.h"
#include "raster/lookup_records.h"
#include "raster/reflection.h"
#include "raster/render_target.h"
#include "raster/shadow_maps.h"
#include "raster/transparency.h"
#include "raster/uniform_slots.h"

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

  // What later bounce iterations change of the capture that draw() makes.
  CaptureLookups lookupsOf(std::size_t pass, const ShownProbes& probes, FacePart shownPart) const;

  // The same objects into an RGBA32UI target: SampleId, 0.
  void drawIds(std::size_t pass, const RenderTarget& target);

 private:
  // An instance, with what is the same in all frames.
  struct Draw {
    SurfaceVariant variant;
    int material;
    std::size_t instance;
    std::shared_ptr<const Mesh> source;
    const GpuMesh* mesh;
    GLuint showingEnvironment;
    GLuint showingProbe;         // 0 for instances that look no probe's cube map up
    GLuint showingBlend;         // 0 for instances that don't look up two
    GLuint showingMirroredView;  // 0 for instances that never do
    bool cullsBackFaces;
    bool isClosedGlass;         // its back faces are seen from inside only
    bool isCapturedFromInside;  // by its own probe
    GLuint backFaces;           // program that draws what its fragments read; 0 if they read none
    GLuint shadow;              // program that draws it to shadow maps; 0 if the scene casts no shadows
    // In captures, which the technique may reduce.
    struct Captured {
      GLuint showingEnvironment = 0, showingProbe = 0, showingBlend = 0, backFaces = 0;
      GLuint recordingProbe = 0;  // none if bounce iterations can't do without drawing it again
      GLuint hidingLookups = 0;   // instead of showingEnvironment before surfaces that may have been recorded
    } captured;

    bool isBlended() const { return variant.coverage == shading::kAlphaBlend; }
  };
  enum class Faces { both, front, back };
  class Binder;

  void buildDraws(const Snapshot& snapshot, const std::vector<int>& probeResolutions);
  bool drawsFit(const Snapshot& snapshot, const std::vector<int>& probeResolutions) const;
  void showShapes();
  void beginShadows();
  std::vector<const Draw*> shadowCasters(const gpu::ShadowFace& face) const;
  SurfaceVariant variantOf(const Snapshot& snapshot, const SnapshotInstance& instance) const;
  void uploadInstances();
  void uploadLights();
  void uploadPasses(const std::vector<gpu::PassConstants>& passes);
  void uploadProbes();
  GLuint bindReflection(const Draw& draw, const ShownProbes& probes) const;
  void bindProbe(const ProbeMaps& maps, int probe) const;
  GLuint markDraw(const Draw& draw, GLuint program, const ShownProbes& probes, const LookupRecords& records) const;
  void beginPass(std::size_t pass, const RenderTarget& target) const;
  bool isVisible(const Draw& draw, std::size_t pass) const;
  MeshNeeds meshNeeds(const SnapshotInstance& instance, bool hasBackFaces) const;
  GLsizei indexCount(const Draw& draw, bool isCapture) const;
  void drawTriangles(const Draw& draw, bool isCapture) const;
  std::vector<const Draw*> visibleDraws(std::size_t pass, int hiddenProbe, FacePart part) const;
  void drawSurfaces(const std::vector<const Draw*>& draws, std::size_t pass, const ShownProbes& probes,
                    const LookupRecords* records = nullptr);
  std::vector<const Draw*> readBehind(const Draw& draw, std::size_t pass) const;
  void drawBackFaces(const Draw& draw, std::size_t pass, Binder& binder);
  Faces facesOf(const Draw& draw, const shading::View& view) const;
  void drawBackground() const;

  RasterDevice::Impl& device_;
  const gl::Functions& gl_;
  Technique technique_;
  std::shared_ptr<SceneResources> resources_;
  std::vector<Reflection> reflections_;  // by instance
  GLuint background_ = 0;
  std::size_t drawnEnvironment_ = 0;  // for which the draws were built
  std::vector<int> drawnResolutions_;
  gl::VertexArray noVertices_;
  const Snapshot* snapshot_ = nullptr;  // between beginFrame() and the last pass of the frame
  std::vector<gpu::PassConstants> passes_;
  std::vector<Draw> draws_;
  UniformSlots<gpu::InstanceConstants> instanceSlots_;
  UniformSlots<gpu::PassConstants> passSlots_;
  UniformSlots<gpu::ProbeConstants> probeSlots_;  // only for lookups that read them
  std::size_t lightCount_ = 0;
  std::size_t areaLightCount_ = 0;
  gl::Buffer lights_;
  gl::Buffer areaLights_;
  std::optional<BackFaces> backFaces_;       // of scenes whose refraction reads them
  std::optional<TransparentLayers> layers_;  // of scenes with blended surfaces
  std::optional<ShadowMaps> shadows_;        // of scenes that cast shadows
};

}  // namespace pb
