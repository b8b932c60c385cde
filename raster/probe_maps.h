// The cube maps of all probes: RGBA16F, a texture a probe, with filtered levels where a technique wants them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "raster/gpu_structs.h"
#include "raster/prefilter.h"
#include "raster/refresh.h"
#include "raster/render_target.h"
#include "scenes/image.h"

namespace pb {

class ProbeMaps {
 public:
  // Double-buffered maps keep what is shown apart from what is captured until publish(). filter: none if nothing looks
  // up other levels than level 0. keepsDistances: for lookups that read them.
  // views: 6, or 1 for maps that are one picture instead of a cube.
  ProbeMaps(gl::Context& context, Programs& programs, int resolution, int probes, int views, bool doubleBuffered,
            ProbeFilter filter, bool keepsDistances);

  // Lookups of the draws that follow read what that probe shows, and what a second one shows if they blend two.
  void bind(int probe) const { bind(probe, gpu::kProbeUnit, gpu::kProbeDepthUnit); }
  void bindSecond(int probe) const { bind(probe, gpu::kSecondProbeUnit, gpu::kSecondProbeDepthUnit); }

  // Attaches the face for capture, with a depth buffer that all faces share unless distances are kept.
  RenderTarget target(const ProbeFace& face);
  // The layers whose captures publish() makes visible.
  const gl::Texture& captured(int probe) const { return mapOf(probe).captured(); }

  // Makes captures visible to the lookups that follow, in level 0.
  void publish(const std::vector<ProbeFace>& captured);

  // Whether a wanted probe has faces that were published and not filtered since.
  bool isStale(const std::vector<bool>& wanted) const;
  // Brings the levels of the wanted probes up to date. Returns the number of texels written.
  std::int64_t filter(const std::vector<bool>& wanted);

  // The faces that are shown, in GL order; empty ones beyond a single view.
  std::array<Image, 6> read(int probe, int level) const;

 private:
  struct Map {
    gl::Texture shownLayers;  // the six faces with their levels
    gl::Texture shown;        // the same as a cube map
    gl::Texture back;         // six faces, only if double-buffered; level 0
    // The depth buffers of the faces, if distances are kept: reversed depth is near / distance along the face's axis,
    // as floats. Zero, infinitely far away, where nothing was captured.
    gl::Texture shownDepthLayers;
    gl::Texture shownDepths;  // the same as a cube map
    gl::Texture backDepths;   // only if double-buffered
    FaceSet unfiltered = 0;

    const gl::Texture& captured() const { return back.id() != 0 ? back : shownLayers; }
    const gl::Texture& capturedDepths() const { return back.id() != 0 ? backDepths : shownDepthLayers; }
  };

  Map makeMap(bool doubleBuffered) const;
  void addDepths(Map& map) const;
  void bind(int probe, int unit, int depthUnit) const;
  Map& mapOf(int probe) { return maps_[static_cast<std::size_t>(probe)]; }
  const Map& mapOf(int probe) const { return maps_[static_cast<std::size_t>(probe)]; }

  const gl::Functions& gl_;
  int resolution_;
  int views_;
  int levels_;  // above level 0
  bool keepsDistances_;
  std::vector<Map> maps_;
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
  std::optional<CubeFilter> filter_;
};

}  // namespace pb
