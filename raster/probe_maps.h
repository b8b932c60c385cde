// The cube maps of all probes: RGBA16F, one cube of an array a probe, with filtered levels where a technique wants
// them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "raster/prefilter.h"
#include "raster/refresh.h"
#include "raster/scene_pass.h"
#include "scenes/image.h"

namespace pb {

class ProbeMaps {
 public:
  // Double-buffered maps keep what is shown apart from what is captured until publish(). filter: none if nothing looks
  // up other levels than level 0.
  ProbeMaps(gl::Context& context, Programs& programs, int resolution, int probes, bool doubleBuffered,
            ProbeFilter filter);

  // Lookups of the draws that follow read what is shown.
  void bind() const;

  // Attaches the face for capture, with a depth buffer that all faces share.
  RenderTarget target(const ProbeFace& face);

  // Makes captures visible to the lookups that follow, in level 0.
  void publish(const std::vector<ProbeFace>& captured);

  // Whether a wanted probe has faces that were published and not filtered since.
  bool isStale(const std::vector<bool>& wanted) const;
  // Brings the levels of the wanted probes up to date. Returns the number of texels written.
  std::int64_t filter(const std::vector<bool>& wanted);

  // The faces that are shown, in GL order.
  std::array<Image, 6> read(int probe, int level) const;

 private:
  const gl::Texture& captured() const { return back_.id() != 0 ? back_ : shown_; }

  const gl::Functions& gl_;
  int resolution_;
  int levels_;  // above level 0
  gl::Texture shown_;
  gl::Texture back_;         // only if double-buffered; level 0
  gl::Texture shownLayers_;  // only if filtered: what is shown as an array
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
  std::optional<CubeFilter> filter_;
  std::vector<FaceSet> unfiltered_;  // by probe
};

}  // namespace pb
