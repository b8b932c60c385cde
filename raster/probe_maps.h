// The cube maps of all probes: RGBA16F, one cube of an array a probe.
#pragma once

#include <array>
#include <vector>

#include "raster/refresh.h"
#include "raster/scene_pass.h"
#include "scenes/image.h"

namespace pb {

class ProbeMaps {
 public:
  // Double-buffered maps keep what is shown apart from what is captured until publish().
  ProbeMaps(gl::Context& context, int resolution, int probes, bool doubleBuffered);

  // Lookups of the draws that follow read what is shown.
  void bind() const;

  // Attaches the face for capture, with a depth buffer that all faces share.
  RenderTarget target(const ProbeFace& face);

  // Makes captures visible to the lookups that follow.
  void publish(const std::vector<ProbeFace>& captured);

  // The faces that are shown, in GL order.
  std::array<Image, 6> read(int probe) const;

 private:
  const gl::Texture& captured() const { return back_.id() != 0 ? back_ : shown_; }

  const gl::Functions& gl_;
  int resolution_;
  gl::Texture shown_;
  gl::Texture back_;  // only if double-buffered
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
};

}  // namespace pb
