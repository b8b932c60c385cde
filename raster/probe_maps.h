// The cube maps of all probes: RGBA16F, a texture a probe, with filtered levels where a technique wants them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "raster/prefilter.h"
#include "raster/refresh.h"
#include "raster/render_target.h"
#include "scenes/image.h"

namespace pb {

class ProbeMaps {
 public:
  // Double-buffered maps keep what is shown apart from what is captured until publish(). filter: none if nothing looks
  // up other levels than level 0.
  ProbeMaps(gl::Context& context, Programs& programs, int resolution, int probes, bool doubleBuffered,
            ProbeFilter filter);

  // Lookups of the draws that follow read what that probe shows.
  void bind(int probe) const;

  // Attaches the face for capture, with a depth buffer that all faces share.
  RenderTarget target(const ProbeFace& face);
  // The layers whose captures publish() makes visible.
  const gl::Texture& captured(int probe) const { return mapOf(probe).captured(); }

  // Makes captures visible to the lookups that follow, in level 0.
  void publish(const std::vector<ProbeFace>& captured);

  // Whether a wanted probe has faces that were published and not filtered since.
  bool isStale(const std::vector<bool>& wanted) const;
  // Brings the levels of the wanted probes up to date. Returns the number of texels written.
  std::int64_t filter(const std::vector<bool>& wanted);

  // The faces that are shown, in GL order.
  std::array<Image, 6> read(int probe, int level) const;

 private:
  struct Map {
    gl::Texture shownLayers;  // the six faces with their levels
    gl::Texture shown;        // the same as a cube map
    gl::Texture back;         // six faces, only if double-buffered; level 0
    FaceSet unfiltered = 0;

    const gl::Texture& captured() const { return back.id() != 0 ? back : shownLayers; }
  };

  Map makeMap(bool doubleBuffered) const;
  Map& mapOf(int probe) { return maps_[static_cast<std::size_t>(probe)]; }
  const Map& mapOf(int probe) const { return maps_[static_cast<std::size_t>(probe)]; }

  const gl::Functions& gl_;
  int resolution_;
  int levels_;  // above level 0
  std::vector<Map> maps_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
  std::optional<CubeFilter> filter_;
};

}  // namespace pb
