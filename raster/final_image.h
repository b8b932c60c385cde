// The image of the camera, S x S samples a pixel.
#pragma once

#include "raster/scene_pass.h"
#include "scenes/image.h"

namespace pb {

// RGBA32F: the control compares values with the reference more exactly than a half's 11 bits. On llvmpipe RGBA16F is no
// faster (plain frame of builtin:mirrors at 640x360: 16.9 ms of processor time with floats, 18.3 ms with halves).
class FinalImage {
 public:
  FinalImage(gl::Context& context, int widthPx, int heightPx, int samplesPerAxis);

  int widthSamples() const { return widthPx_ * samplesPerAxis_; }
  int heightSamples() const { return heightPx_ * samplesPerAxis_; }

  RenderTarget target() const { return {framebuffer_.id(), widthSamples(), heightSamples()}; }

  // Samples averaged in fixed order.
  Image read() const;

 private:
  const gl::Functions& gl_;
  int widthPx_;
  int heightPx_;
  int samplesPerAxis_;
  gl::Texture color_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
};

// Renders and reads ids of widthSamples x heightSamples; `draw` draws to the target it is given.
class IdImage {
 public:
  IdImage(gl::Context& context, int widthSamples, int heightSamples);

  RenderTarget target() const { return {framebuffer_.id(), widthSamples_, heightSamples_}; }
  Grid<SampleId> read() const;

 private:
  const gl::Functions& gl_;
  int widthSamples_;
  int heightSamples_;
  gl::Texture ids_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
};

}  // namespace pb
