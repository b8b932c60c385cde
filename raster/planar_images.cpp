#include "raster/planar_images.h"

namespace pb {

void PlanarImages::reserve(std::size_t views) {
  const gl::Functions& gl = context_.functions();
  const auto make = [&](GLenum format) {
    return gl::makeTexture(
        gl, {.target = GL_TEXTURE_2D, .format = format, .width = widthSamples_, .height = heightSamples_});
  };
  if (images_.size() >= views) return;
  if (depth_.id() == 0) depth_ = make(GL_DEPTH_COMPONENT32F);
  while (images_.size() < views) {
    images_.push_back(make(GL_RGBA16F));
    context_.check("allocating the images of mirrored views");
    framebuffers_.push_back(gl::makeFramebuffer(gl, images_.back(), depth_));
  }
}

RenderTarget PlanarImages::target(std::size_t view) {
  return {framebuffers_[view].id(), widthSamples_, heightSamples_};
}

}  // namespace pb
