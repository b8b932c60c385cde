// Captures as exponential averages over frames (Technique::hysteresis).
#pragma once

#include <array>
#include <vector>

#include "raster/gl/objects.h"
#include "raster/programs.h"
#include "raster/refresh.h"
#include "raster/render_target.h"

namespace pb {

class CaptureHistory {
 public:
  // `share` of the earlier content is kept at each capture, in [0, 1).
  CaptureHistory(gl::Context& context, Programs& programs, float share);

  // Replaces a face that has been captured, layer face.face of `captured` and the target's colour, by
  // share * earlier + (1 - share) * captured. Earlier is what the frames before left: a frame's bounce iterations all
  // mix with that, and `isLast` keeps the last one's for the frames that come. The first capture of a face stays as it
  // is.
  void blend(const ProbeFace& face, const RenderTarget& target, const gl::Texture& captured, bool isLast);

  // Follows probes that are numbered anew; see probesBefore().
  void reorder(const std::vector<int>& before);

 private:
  struct Earlier {
    gl::Texture layers;
    int sizePx = 0;
    std::array<bool, 6> isKept{};
  };

  Earlier& earlierOf(int probe, const RenderTarget& target, const gl::Texture& captured);
  void mixIn(const Earlier& earlier, int face, const RenderTarget& target) const;

  const gl::Functions& gl_;
  GLuint program_;
  float share_;
  gl::VertexArray noVertices_;
  std::vector<Earlier> earlier_;  // by probe
};

}  // namespace pb
