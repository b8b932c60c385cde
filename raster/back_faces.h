// The back faces of one transmitting object from one view: what two-interface refraction reads behind a fragment.
#pragma once

#include <array>
#include <map>
#include <utility>

#include "raster/gl/objects.h"
#include "raster/limits.h"

namespace pb {

// RGBA32F: inward normal and distance from the viewer, zero where there is nothing (raster/shaders/back_faces.frag).
// One texture for each size of target, made when first asked for.
class BackFaces {
 public:
  BackFaces(gl::Context& context, const DeviceLimits& limits) : context_(context), limits_(limits) {}

  // As long as it lives, draws go to the target and the farthest surface stays. Then they go where they went before,
  // and read the target.
  class Drawing {
   public:
    Drawing(const gl::Functions& gl, GLuint framebuffer, GLuint surface);
    ~Drawing();
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;

   private:
    const gl::Functions& gl_;
    GLuint surface_;
    GLint framebufferBefore_ = 0, depthFuncBefore_ = 0;
    GLboolean writesDepthBefore_ = GL_TRUE;
    std::array<GLboolean, 4> writesColorBefore_{};
    GLboolean scissorsBefore_ = GL_FALSE;
  };

  // The emptied target of that size. Throws an input Error when it would not fit the device.
  Drawing beginDraws(int widthPx, int heightPx);

 private:
  struct Target {
    gl::Texture surface;
    gl::Texture depth;
    gl::Framebuffer framebuffer;
  };
  Target& targetOf(int widthPx, int heightPx);

  gl::Context& context_;
  DeviceLimits limits_;
  std::map<std::pair<int, int>, Target> targets_;
};

}  // namespace pb
