// What is captured, six faces of a cube, as what is shown: in another format, or as another map of directions
// (scenes/shading/probe_map.glsl).
#pragma once

#include "raster/prefilter.h"
#include "raster/technique.h"

namespace pb {

// The squares that hold a probe's map. Those of other maps than cubes have one texel around them, and within it as many
// texels as the cube, rounded up to even edges: errors are the map's, not those of its size.
struct MapSquares {
  int edge;
  int count;
};
MapSquares mapSquares(Storage storage, int resolution);

// Throws an input Error for settings of maps that don't go together, with those levels (levelFilter()).
void checkMaps(const Technique& technique, ProbeFilter levels);

// Whether maps are not shown as they are captured.
bool isConverted(ProbeFormat format, Storage storage);

class MapConversion {
 public:
  // isConverted(). Without `seamless`, texels are not filtered across the edges of the captured faces.
  MapConversion(gl::Context& context, Programs& programs, ProbeFormat format, Storage storage, int resolution,
                bool seamless);

  // Fills what the changed faces concern of the shown map's level 0. captured: the layers, or for other maps than cubes
  // the same as a cube map; image: makeImageView() of the shown ones. Returns the number of texels written. Lookups
  // that follow see them.
  std::int64_t run(const gl::Texture& captured, const gl::Texture& shownLayers, const gl::Texture& image,
                   FaceSet changed) const;

 private:
  const gl::Functions& gl_;
  TexelFormat format_;
  Storage storage_;
  MapSquares squares_;
  bool seamless_;
  GLuint program_;
};

}  // namespace pb
