// The maps of all probes: a texture a probe, with filtered levels where a technique wants them. Alpha of
// level 0 of RGBA16F cubes is 0 where no later bounce iteration of the frame changes what was captured
// (raster/lookup_records.h).
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "raster/gpu_structs.h"
#include "raster/map_conversion.h"
#include "raster/prefilter.h"
#include "raster/refresh.h"
#include "raster/render_target.h"
#include "scenes/image.h"

namespace pb {

class ProbeMaps {
 public:
  struct Settings {
    std::vector<int> resolutions;            // by probe: texels along the edge of a face
    int largest;                             // that any will have
    int views = 6;                           // 1 for maps that are one picture instead of a cube
    bool doubleBuffered = false;             // what is shown is kept apart from what is captured until publish()
    bool capturesApart = false;              // small cubes are drawn to others that all share, and copied
    ProbeFilter filter = ProbeFilter::none;  // none if nothing looks up other levels than level 0
    bool keepsDistances = false;             // for lookups that read them
    ProbeFormat format = ProbeFormat::rgba16f;
    Storage storage = Storage::cube;  // others have no levels
    bool seamless = true;
  };
  ProbeMaps(gl::Context& context, Programs& programs, const Settings& settings);

  // Lookups of the draws that follow read what that probe shows, and what a second one shows if they blend two.
  void bind(int probe) const { bind(probe, gpu::kProbeUnit, gpu::kProbeDepthUnit); }
  void bindSecond(int probe) const { bind(probe, gpu::kSecondProbeUnit, gpu::kSecondProbeDepthUnit); }

  // Follows probes that are numbered anew; see probesBefore(). New ones get maps of that many texels (by probe), which
  // show nothing until they are captured.
  void reorder(const std::vector<int>& before, const std::vector<int>& resolutions);

  // Makes a map anew with another number of texels. What it shows is scaled, until all of its faces are captured.
  void resize(int probe, int resolution);

  // Attaches the face for capture, with a depth buffer that all faces share unless distances are kept.
  RenderTarget target(const ProbeFace& face);
  // The same with further colours, textures of the maps' size, which were given before, and after them the face's layer
  // of one more if that isn't nullptr. Not for kept distances.
  RenderTarget recordingTarget(const ProbeFace& face, const gl::Texture* lastColor);
  void setFurtherColors(std::span<const gl::Texture* const> colors);
  // The layers that both draw to until publish().
  const gl::Texture& drawn(int probe) const;
  // The layers of a published probe whose changes the next publish() makes visible.
  const gl::Texture& captured(int probe) const { return mapOf(probe).captured(); }

  // Shows that instead of a capture. faces: GL order, row 0 first in memory, of the probe's resolution; what the format
  // can't hold becomes the largest radiance that it can. distances, for kept ones: metres along the axis of the face,
  // infinite where nothing is; zNear as of captures.
  void write(int probe, const std::array<Image, 6>& faces, const std::array<Plane, 6>& distances, float zNear);

  // Makes captures visible to the lookups that follow, in level 0. Returns the number of texels that a conversion
  // wrote.
  std::int64_t publish(const std::vector<ProbeFace>& captured);

  // Whether a wanted probe has faces that were published and not filtered since.
  bool isStale(const std::vector<bool>& wanted) const;
  // Brings the levels of the wanted probes up to date. Returns the number of texels written.
  std::int64_t filter(const std::vector<bool>& wanted);

  // The faces that are shown, in GL order; empty ones beyond a single view. Of other maps than cubes, the captured
  // ones.
  std::array<Image, 6> read(int probe, int level) const;
  // As given to write(); for kept distances.
  std::array<Plane, 6> readDistances(int probe, float zNear) const;

 private:
  struct Map {
    int resolution;
    gl::Texture shownLayers;  // the six faces with their levels, or another map's squares
    gl::Texture shownImage;   // makeImageView()
    gl::Texture shown;        // the same as lookups read it
    gl::Texture back;         // six faces, only if double-buffered or converted; level 0
    gl::Texture backCube;     // the same as a cube map, for other maps than cubes
    // The depth buffers of the faces, if distances are kept: reversed depth is near / distance along the face's axis,
    // as floats. Zero, infinitely far away, where nothing was captured.
    gl::Texture shownDepthLayers;
    gl::Texture shownDepths;  // the same as a cube map
    gl::Texture backDepths;   // only if there is a back
    FaceSet unfiltered = 0;

    const gl::Texture& captured() const { return back.id() != 0 ? back : shownLayers; }
    const gl::Texture& capturedDepths() const { return back.id() != 0 ? backDepths : shownDepthLayers; }
  };

  // What works on maps of one resolution.
  struct Tools {
    int levels;  // above level 0
    std::optional<CubeFilter> filter;
    std::optional<MapConversion> conversion;
    // Six faces that captures are drawn to, one probe's at a time, if that is apart from its map. Like the depth buffer
    // that they share, no part of probeBytes(), which counts what techniques want, not what drivers do.
    gl::Texture apart;
  };

  Map makeMap(int resolution);
  Tools& toolsFor(int resolution);
  void addShown(Map& map, int levels) const;
  void addDepths(Map& map) const;
  void bind(int probe, int unit, int depthUnit) const;
  bool hasBacks() const { return settings_.doubleBuffered || isConverted(settings_.format, settings_.storage); }
  bool drawsApart(int resolution) const;
  void beginFace(const ProbeFace& face);
  void copyDrawn();
  Map& mapOf(int probe) { return maps_[static_cast<std::size_t>(probe)]; }
  const Map& mapOf(int probe) const { return maps_[static_cast<std::size_t>(probe)]; }

  void copyToShown(const Map& map, int face) const;
  void copyFace(const gl::Texture& from, const gl::Texture& to, int face, int resolution) const;
  void writeRadiances(const Map& map, int face, Image radiances) const;
  void writeDistances(const Map& map, int face, Plane distances, float zNear) const;

  gl::Context& context_;
  const gl::Functions& gl_;
  Programs& programs_;
  const Settings settings_;
  const TexelFormat format_;
  std::map<int, Tools> tools_;  // by resolution
  std::vector<Map> maps_;
  int drawnProbe_ = 0;      // whose captures are drawn apart
  FaceSet drawnFaces_ = 0;  // its faces that are, and not yet copied
  gl::Texture depth_;
  gl::Framebuffer framebuffer_;
  gl::Framebuffer recordingFramebuffer_;
  GLenum furtherColors_ = 0;  // how many
};

}  // namespace pb
