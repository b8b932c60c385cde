// Shadow maps of the punctual lights of scenes that cast shadows: depths seen from the lights, one face for directional
// and narrow spot lights, six faces of a cube for the others. Lookups are raster/shaders/shadow_lookup.glsl.
#pragma once

#include <vector>

#include "raster/gl/objects.h"
#include "raster/gpu_structs.h"
#include "raster/limits.h"
#include "raster/uniform_slots.h"
#include "scenes/snapshot.h"

namespace pb {

struct RenderTarget;

// The faces of the light's map of resolution x resolution texels. They see everything that may throw a shadow into
// `casters`, with a texel to spare on each side, so that lookups filter without looking across edges.
std::vector<gpu::ShadowFace> shadowFacesOf(const shading::Light& light, const Bounds& casters, int resolution);

bool castsShadows(const Snapshot& snapshot);

class ShadowMaps {
 public:
  // `resolution`: texels along a face's edge.
  ShadowMaps(gl::Context& context, const DeviceLimits& limits, int resolution);

  // Where the lights' faces lie. Throws an input Error when they don't fit the device.
  void beginFrame(const Snapshot& snapshot);

  const std::vector<gpu::ShadowFace>& faces() const { return faces_; }
  // The snapshot's lights with their faces noted in them, as the lookups want them.
  const std::vector<shading::Light>& lights() const { return lights_; }

  // Attaches a face to be drawn to; scene.vert then projects by it.
  RenderTarget target(std::size_t face);
  // Draws that follow look the maps up.
  void bind() const;

 private:
  void allocate(int layers);

  gl::Context& context_;
  const gl::Functions& gl_;
  DeviceLimits limits_;
  int resolution_;
  std::vector<gpu::ShadowFace> faces_;
  std::vector<shading::Light> lights_;
  UniformSlots<gpu::ShadowFace> faceSlots_;  // for drawing
  gl::Buffer faceBuffer_;                    // for lookups
  int layers_ = 0;
  gl::Texture depths_;
  gl::Framebuffer framebuffer_;
};

}  // namespace pb
