#include "raster/map_conversion.h"

#include <bit>
#include <cmath>

#include "raster/lookup.h"
#include "scenes/error.h"

namespace pb {
namespace {

int evenAbove(double x) { return 2 * static_cast<int>(std::ceil(0.5 * x)); }

}  // namespace

MapSquares mapSquares(Storage storage, int resolution) {
  switch (storage) {
    case Storage::cube:
      return {resolution, 6};
    case Storage::octahedral:
      return {2 + evenAbove(std::sqrt(6.0) * resolution), 1};
    case Storage::dualParaboloid:
      return {2 + evenAbove(std::sqrt(3.0) * resolution), 2};
  }
  return {};
}

void checkMaps(const Technique& technique, ProbeFilter levels) {
  const bool isSingleView = viewsOfProbe(technique) == 1;
  if (isSingleView && technique.mips)
    throwInputError("the maps of lookup = single-view have no mipmaps: mips must be off");
  if (technique.storage == Storage::cube) return;
  if (isSingleView) throwInputError("the maps of lookup = single-view are no cubes to convert: storage must be cube");
  if (technique.mips) throwInputError("only maps with storage = cube have mipmaps: mips must be off");
  if (levels != ProbeFilter::none)
    throwInputError("only maps with storage = cube have levels for rough surfaces: filter must be none in this scene");
}

bool isConverted(ProbeFormat format, Storage storage) {
  return texelFormat(format).isConverted() || storage != Storage::cube;
}

MapConversion::MapConversion(gl::Context& context, Programs& programs, ProbeFormat format, Storage storage,
                             int resolution, bool seamless)
    : gl_(context.functions()),
      format_(texelFormat(format)),
      storage_(storage),
      squares_(mapSquares(storage, resolution)),
      seamless_(seamless),
      program_(storage == Storage::cube ? programs.copyTexels(format_.defines)
                                        : programs.convertMap(storage, format_.defines)) {}

std::int64_t MapConversion::run(const gl::Texture& captured, const gl::Texture& shownLayers, const gl::Texture& image,
                                FaceSet changed) const {
  const gl::Texture& target = image.id() != 0 ? image : shownLayers;
  const FaceSet squares = storage_ == Storage::cube ? changed : (1u << squares_.count) - 1u;
  bindFilterSource(gl_, captured);
  if (!seamless_) gl_.Disable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  dispatchFaces(gl_, program_, target, format_.image, 0, squares_.edge, squares);
  if (!seamless_) gl_.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  gl_.MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  return std::int64_t{std::popcount(squares)} * squares_.edge * squares_.edge;
}

}  // namespace pb
