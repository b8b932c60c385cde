// Blended surfaces of a pass, composed in depth order at every sample: exact and independent of the order of drawing.
// Ties of depth are broken by instance and triangle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "raster/gl/objects.h"

namespace pb {

struct RenderTarget;

class TransparentLayers {
 public:
  TransparentLayers(gl::Context& context, GLuint composeProgram);

  // Calls `draw` to draw all blended surfaces with programs that store layers (raster/shaders/layers.glsl), then lays
  // them over the colours of the target, which is bound; surfaces behind the target's depth don't count. `draw` is
  // called again, with less of the target's rows at a time, when there are more layers than memory for them. Throws an
  // environment Error if there is not enough for a single row.
  void compose(const RenderTarget& target, const std::function<void()>& draw);

 private:
  struct Rows {
    int first;
    int count;
  };
  // As in raster/shaders/layers.glsl.
  struct LayerCounts {
    std::uint32_t layers = 0;
    std::uint32_t notComposed = 0;
  };

  void composeRows(const RenderTarget& target, Rows rows, const std::function<void()>& draw);
  std::size_t collect(const RenderTarget& target, Rows rows, const std::function<void()>& draw);
  void overlay();
  LayerCounts readCounts() const;
  void fitHeads(int widthPx, int heightPx);
  void reserve(std::size_t layers);

  const gl::Functions& gl_;
  GLuint program_;
  std::size_t largestCapacity_;
  std::size_t capacity_ = 0;  // layers
  gl::Buffer layers_;
  gl::Texture heads_;
  int headsWidthPx_ = 0;
  int headsHeightPx_ = 0;
  gl::VertexArray noVertices_;
};

}  // namespace pb
