// A scene's meshes, materials, textures and environments on the device: uploaded once, then only read, except what
// changes with time: the shapes of deforming meshes and the pictures on screens.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/gpu_mesh.h"
#include "raster/gpu_structs.h"
#include "raster/prefilter.h"
#include "raster/programs.h"
#include "raster/uniform_slots.h"
#include "scenes/scene.h"

namespace pb {

// What draws of an instance need besides its mesh.
struct MeshNeeds {
  bool inwardDistances = false;
  float share = 1.0f;          // GpuMesh::simplified, if below 1
  bool planes = false;         // GpuMesh::planes
  const Mesh* rest = nullptr;  // the instance's mesh before any deformation, which decides what is simplified
};

class SceneResources {
 public:
  SceneResources(gl::Context& context, std::shared_ptr<const Scene> scene);

  const std::shared_ptr<const Scene>& scene() const { return scene_; }

  // The mesh of an instance, by its number in the snapshot. Uploaded when first asked for; what deforms is uploaded
  // anew for another shape, into the same object.
  const GpuMesh& mesh(std::size_t instance, const std::shared_ptr<const Mesh>& mesh, const MeshNeeds& needs);

  SurfaceVariant variantOf(int material, const Mesh& mesh, TextureFilter filter) const;

  // Makes what bindPlainMaterial() binds, for these pictures of the scene's screens (Snapshot::screens).
  void showPlainMaterials(const std::vector<Texture>& screens);

  // Uploads the pictures of the scene's screens (Snapshot::screens) that are not shown already.
  void showScreens(const std::vector<Texture>& screens);

  // The environment that everything below is about, by its number for Scene::environmentAt().
  void showEnvironment(std::size_t index);

  // Makes the filtered environment unless nothing looks it up. Returns the texels along its edge.
  int filterEnvironment(ProbeFilter filter, Programs& programs);

  // Binds the scene's constants and environment for all draws that follow.
  void bindScene() const;
  // Binds what the technique's reflections read: its DFG table and its filtered environment.
  void bindReflection(const Technique& technique);
  // Binds one material's constants, textures and samplers.
  void bindMaterial(int material) const;
  // The same for draws of its plainVariant().
  void bindPlainMaterial(int material) const;

 private:
  struct Binding {
    GLuint unit;
    GLuint texture;
    GLuint sampler;
  };

  struct GpuEnvironment {
    gl::Texture faces;
    gl::Texture cube;
    std::map<ProbeFilter, FilteredEnvironment> filtered;  // made when first asked for
  };

  void bindTextures(int material) const;
  void uploadTextures();
  void makeScreens();
  void uploadMaterials(gl::Context& context);
  void uploadEnvironment(std::size_t index);
  const gl::Texture& dfgTableOf(GeometryTerm term);
  GLuint samplerFor(const glm::vec4& settings);

  gl::Context& context_;
  const gl::Functions& gl_;
  std::shared_ptr<const Scene> scene_;
  std::map<const Mesh*, GpuMesh> meshes_;    // of instances that don't deform
  std::map<std::size_t, GpuMesh> deformed_;  // by instance
  std::vector<gl::Texture> textures_;        // the scene's textures, then its screens
  std::vector<ImageRgba> shownOnScreens_;    // by screen: level 0 of what is uploaded
  std::map<std::array<float, 4>, gl::Sampler> samplers_;
  std::vector<std::vector<Binding>> materialBindings_;  // by material
  UniformSlots<shading::MaterialConstants> materials_;
  UniformSlots<shading::MaterialConstants> plainMaterials_;  // only for techniques that draw them
  UniformSlots<gpu::SceneConstants> constants_;
  std::vector<GpuEnvironment> environments_;  // made when first shown
  std::size_t shownEnvironment_ = 0;
  std::array<gl::Texture, 4> dfgTables_;  // by GeometryTerm, made when first bound
};

}  // namespace pb
