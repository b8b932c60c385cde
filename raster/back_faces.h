// The back faces of one transmitting object from one view: what two-interface refraction reads behind a fragment.
#pragma once

#include <map>
#include <utility>

#include "raster/gl/objects.h"

namespace pb {

// RGBA32F: inward normal and distance from the viewer, zero where there is nothing (raster/shaders/back_faces.frag).
// One texture for each size of target, made when first asked for.
class BackFaces {
 public:
  explicit BackFaces(gl::Context& context) : context_(context) {}

  // The next draws go to the emptied target of that size and leave the farthest surface.
  void beginDraws(int widthPx, int heightPx);

  // The draws that follow read that target.
  void bind() const;

 private:
  struct Target {
    gl::Texture surface;
    gl::Texture depth;
    gl::Framebuffer framebuffer;
  };
  Target& targetOf(int widthPx, int heightPx);

  gl::Context& context_;
  std::map<std::pair<int, int>, Target> targets_;
  const Target* current_ = nullptr;
};

}  // namespace pb
