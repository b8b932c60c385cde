// What is drawn of a scene, in order, and the programs that draw it: the same in all frames that show the same
// instances under the same environment with probes of the same resolutions.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "raster/device.h"
#include "raster/scene_resources.h"

namespace pb {

// An instance.
struct SurfaceDraw {
  SurfaceVariant variant;
  int material;
  std::size_t instance;
  std::shared_ptr<const Mesh> source;
  const GpuMesh* mesh;
  bool cullsBackFaces;
  bool isClosedGlass;         // its back faces are seen from inside only
  bool isCapturedFromInside;  // by its own probe
  int mapResolution;          // texels along a face's edge of the map whose levels it reads

  // Programs by what the surface shows. 0: it never shows that.
  struct Shown {
    GLuint showingEnvironment = 0;
    GLuint showingProbe = 0;
    GLuint showingBlend = 0;  // of two probes
    GLuint backFaces = 0;     // draws what the surface's fragments read
  };
  Shown shown;
  GLuint showingMirroredView = 0;
  GLuint shadow = 0;  // draws it to shadow maps
  // In captures, which the technique may reduce.
  struct Captured : Shown {
    GLuint recordingProbe = 0;  // none if bounce iterations can't do without drawing it again
    LookupRecord record = LookupRecord::general;
  } captured;

  bool isBlended() const { return variant.coverage == shading::kAlphaBlend; }
  // Of the whole mesh, or of the share of its triangles that captures draw.
  GLsizei indexCount(float share) const {
    return share < 1.0f ? mesh->simplified.at(share).indexCount : mesh->indexCount;
  }
};

class SceneDraws {
 public:
  SceneDraws(RasterDevice::Impl& device, const Technique& technique) : device_(device), technique_(technique) {}

  // Takes the snapshot's instances, with the shapes that they have in it. isNew: the scene is another one than before.
  void show(const Snapshot& snapshot, SceneResources& resources, const std::vector<int>& probeResolutions, bool isNew);

  // Blended surfaces last.
  const std::vector<SurfaceDraw>& all() const { return draws_; }
  bool haveBackFaces() const;
  bool haveBlended() const { return !draws_.empty() && draws_.back().isBlended(); }
  GLuint background() const { return background_; }

 private:
  bool fit(const Snapshot& snapshot, const std::vector<int>& probeResolutions) const;
  void build(const Snapshot& snapshot, SceneResources& resources, const std::vector<int>& probeResolutions);
  bool isClosed(const Mesh& mesh);
  MeshNeeds meshNeeds(const Snapshot& snapshot, const SnapshotInstance& instance, bool hasBackFaces) const;

  RasterDevice::Impl& device_;
  const Technique& technique_;
  std::vector<SurfaceDraw> draws_;
  GLuint background_ = 0;
  std::size_t environment_ = 0;  // for which the draws were built
  std::vector<float> lightKinds_;
  std::vector<int> resolutions_;
  std::map<const Mesh*, bool> isClosed_;  // of those of the scene's meshes that were asked for
};

}  // namespace pb
