// Cube maps filtered for rough reflections: levels above level 0, each for a wider lobe (raster/shaders/gloss_lod.glsl
// says which). Levels belong to the technique's ProbeFilter; all are functions of level 0 alone.
#pragma once

#include <array>
#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/programs.h"
#include "raster/technique.h"
#include "raster/texel_format.h"
#include "raster/uniform_slots.h"
#include "scenes/scene.h"

namespace pb {

// Levels above level 0 of a filtered cube map with `resolution` texels along an edge; 0 for filter = none.
int filteredLevels(ProbeFilter filter, int resolution);

// Perceptual roughness that a level stands for under ggx-prefiltered.
float levelRoughness(int level, int levels);

// Whether the material's specular lobe is anywhere wider than a mirror's.
bool hasRoughLobe(const Material& material);

// Bytes of the cubes' levels above level 0, and of the working copy that the filter of all cubes shares.
std::int64_t filteredBytes(ProbeFilter filter, int resolution, int cubes, std::int64_t texelBytes);

// What shaders write to layers of the format through: a view of them, unless images have the format itself (no
// texture).
gl::Texture makeImageView(const gl::Texture& layers, const TexelFormat& format, int levels, int layerCount);

// Directions of equal weight whose density is the kernel D(NoH) NoL of a lobe seen along its axis +Z, with the solid
// angle in steradians that each stands for in w.
inline constexpr int kLobeSamples = 64;
std::array<glm::vec4, kLobeSamples> lobeSamples(float alpha);

// Faces of a cube, one bit each.
using FaceSet = unsigned;
inline constexpr FaceSet kAllFaces = 63;

class CubeFilter {
 public:
  // For cubes of `resolution` texels along an edge; filter is not none.
  CubeFilter(gl::Context& context, Programs& programs, ProbeFilter filter, const TexelFormat& format, int resolution);

  // Fills the levels of a cube (seen as GL_TEXTURE_2D_ARRAY) as far as they depend on the changed faces of its level 0.
  // image: makeImageView() of it. Returns the number of texels written. Lookups and reads that follow see them.
  std::int64_t run(const gl::Texture& layers, const gl::Texture& image, FaceSet changed);

 private:
  struct Lobes {
    std::array<glm::vec4, kLobeSamples> samples;
  };

  void fillBoxLevel(GLuint program, const gl::Texture& layers, const gl::Texture& target, int level, FaceSet faces);
  void fillGgxLevel(const gl::Texture& target, int level, FaceSet faces);
  void dispatch(GLuint program, const gl::Texture& target, int level, FaceSet faces);
  std::int64_t texels(int level, FaceSet faces) const;

  const gl::Functions& gl_;
  ProbeFilter filter_;
  const TexelFormat format_;
  int resolution_;
  int levels_;
  GLuint boxProgram_;
  // ggx-prefiltered only.
  GLuint ggxProgram_ = 0;
  UniformSlots<Lobes> lobes_;          // by level - 1
  std::vector<bool> reachesOpposite_;  // by level - 1: lobes reach from a face into the one opposite
  gl::Texture sourceLayers_;           // one cube with box-filtered levels, which the samples read
  gl::Texture sourceImage_;
  gl::Texture source_;
};

// Fills level `level` of some faces of a texture's layers, written as images of that format, by a compute shader that
// includes prefilter.glsl; edge: texels of the level.
void dispatchFaces(const gl::Functions& gl, GLuint program, const gl::Texture& target, GLenum imageFormat, int level,
                   int edge, FaceSet faces);
// What such a shader reads.
void bindFilterSource(const gl::Functions& gl, const gl::Texture& source);

// An environment with its filtered levels.
struct FilteredEnvironment {
  int resolution = 0;
  gl::Texture layers;
  gl::Texture cube;
};

// Texels along the edge that the environment's finest detail needs, at most 512.
int filteredEnvironmentResolution(const Environment& environment);

// The scene's constants and environment must be bound (SceneResources::bindScene).
FilteredEnvironment filterEnvironment(gl::Context& context, Programs& programs, const Environment& environment,
                                      ProbeFilter filter);

}  // namespace pb
