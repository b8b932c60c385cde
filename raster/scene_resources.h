// A scene's meshes, materials, textures and environment on the device: uploaded once, then only read.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/gpu_structs.h"
#include "raster/prefilter.h"
#include "raster/programs.h"
#include "raster/uniform_slots.h"
#include "scenes/scene.h"

namespace pb {

struct GpuMesh {
  GpuMesh(const gl::Functions& gl, std::shared_ptr<const Mesh> source_);

  std::shared_ptr<const Mesh> source;  // kept, so that its address stays its own
  gl::VertexArray vertexArray;
  gl::Buffer vertices;
  gl::Buffer indices;
  gl::Buffer smoothingGroups;  // one uint a triangle
  gl::Buffer inwardDistances;  // one float a vertex, only after SceneResources::addInwardDistances()
  GLsizei indexCount;
};

class SceneResources {
 public:
  SceneResources(gl::Context& context, std::shared_ptr<const Scene> scene);

  const std::shared_ptr<const Scene>& scene() const { return scene_; }

  // Uploaded when first asked for.
  const GpuMesh& mesh(const std::shared_ptr<const Mesh>& mesh);
  // The vertex attribute of two-interface refraction (raster/inward_distance.h), computed when first asked for.
  void addInwardDistances(const std::shared_ptr<const Mesh>& mesh);

  SurfaceVariant variantOf(int material, const Mesh& mesh, TextureFilter filter) const;

  // Uploads the pictures of the scene's screens (Snapshot::screens) that are not shown already.
  void showScreens(const std::vector<Texture>& screens);

  // Makes the filtered environment unless nothing looks it up. Returns the texels along its edge.
  int filterEnvironment(ProbeFilter filter, Programs& programs);

  // Binds the scene's constants and environment for all draws that follow.
  void bindScene() const;
  // Binds what the technique's reflections read: its DFG table and its filtered environment.
  void bindReflection(const Technique& technique);
  // Binds one material's constants, textures and samplers.
  void bindMaterial(int material) const;

 private:
  struct Binding {
    GLuint unit;
    GLuint texture;
    GLuint sampler;
  };

  void uploadTextures();
  void makeScreens();
  void uploadMaterials(gl::Context& context);
  void uploadEnvironment();
  const gl::Texture& dfgTableOf(GeometryTerm term);
  GLuint samplerFor(const glm::vec4& settings);

  gl::Context& context_;
  const gl::Functions& gl_;
  std::shared_ptr<const Scene> scene_;
  std::map<const Mesh*, GpuMesh> meshes_;
  std::vector<gl::Texture> textures_;      // the scene's textures, then its screens
  std::vector<ImageRgba> shownOnScreens_;  // by screen: level 0 of what is uploaded
  std::map<std::array<float, 4>, gl::Sampler> samplers_;
  std::vector<std::vector<Binding>> materialBindings_;  // by material
  UniformSlots<shading::MaterialConstants> materials_;
  UniformSlots<gpu::SceneConstants> constants_;
  gl::Texture environmentFaces_;
  gl::Texture environmentCube_;
  std::array<gl::Texture, 4> dfgTables_;                 // by GeometryTerm, made when first bound
  std::map<ProbeFilter, FilteredEnvironment> filtered_;  // made when first asked for
};

}  // namespace pb
