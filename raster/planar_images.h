// What the mirrored views of a frame show, one image a view: RGBA16F, as many samples as the final image.
#pragma once

#include <vector>

#include "raster/gl/objects.h"
#include "raster/render_target.h"

namespace pb {

class PlanarImages {
 public:
  PlanarImages(gl::Context& context, int widthSamples, int heightSamples)
      : context_(context), widthSamples_(widthSamples), heightSamples_(heightSamples) {}

  // Makes images for that many views.
  void reserve(std::size_t views);

  // Attaches the image of a view, with a depth buffer that all views share.
  RenderTarget target(std::size_t view);
  GLuint image(std::size_t view) const { return images_[view].id(); }

 private:
  gl::Context& context_;
  int widthSamples_;
  int heightSamples_;
  std::vector<gl::Texture> images_;
  gl::Texture depth_;
  std::vector<gl::Framebuffer> framebuffers_;
};

}  // namespace pb
