#include "raster/refraction.h"

namespace pb {
namespace {

bool isGlass(const Material& material) { return material.constants.kind.x == shading::kSurfaceGlass; }

std::string interfaceDefine(Refraction refraction) {
  switch (refraction) {
    case Refraction::oneInterface:
      return "";
    case Refraction::twoInterface:
      return "#define REFRACTION_TWO_INTERFACE\n";
    case Refraction::cubemapBackface:
      return "#define REFRACTION_CUBEMAP_BACKFACE\n";
    case Refraction::thickSlab:
      return "#define REFRACTION_THICK_SLAB\n";
  }
  return "";
}

std::string dispersionDefine(Dispersion dispersion, const Material& material) {
  if (material.constants.kind.w <= 0.0f || dispersion == Dispersion::off) return "";
  return dispersion == Dispersion::rgbOffset ? "#define DISPERSION_RGB_OFFSET\n" : "#define DISPERSION_PER_CHANNEL\n";
}

}  // namespace

bool isSolidGlass(const Material& material) { return isGlass(material) && material.constants.kind.z > 0.0f; }

bool readsBackFaces(const Technique& technique, const Material& material) {
  return technique.refraction == Refraction::twoInterface && isSolidGlass(material);
}

bool isCapturedFromInside(const Technique& technique, const Material& material) {
  return technique.refraction == Refraction::cubemapBackface && isSolidGlass(material);
}

std::string refractionDefines(const Technique& technique, const Material& material) {
  if (!isGlass(material)) return "";
  if (!isSolidGlass(material)) return "#define REFRACTION_THIN_WALL\n";
  return interfaceDefine(technique.refraction) + dispersionDefine(technique.dispersion, material);
}

}  // namespace pb
