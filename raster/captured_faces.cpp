#include "raster/captured_faces.h"

#include "raster/lookup.h"

namespace pb {
namespace {

constexpr int kTop = 2, kBottom = 3;

}  // namespace

FacePart capturedPart(const Technique& technique, int face) {
  if (viewsOfProbe(technique) == 1) return FacePart::whole;
  const bool isSide = face != kTop && face != kBottom;
  switch (technique.faces) {
    case CapturedFaces::all:
      return FacePart::whole;
    case CapturedFaces::noTopBottom:
      return isSide ? FacePart::whole : FacePart::nothing;
    case CapturedFaces::topHalf:
      return isSide ? FacePart::upperHalf : face == kTop ? FacePart::whole : FacePart::nothing;
  }
  return FacePart::whole;
}

int capturedFaceCount(const Technique& technique) {
  int count = 0;
  for (int face = 0; face < 6; ++face) count += capturedPart(technique, face) == FacePart::nothing ? 0 : 1;
  return count;
}

bool isOutsidePart(const Bounds& box, const glm::vec3& origin, FacePart part) {
  return part == FacePart::nothing || (part == FacePart::upperHalf && box.upper.y < origin.y);
}

int rowsOf(FacePart part, int n) {
  if (part == FacePart::nothing) return 0;
  return part == FacePart::upperHalf ? n / 2 : n;
}

}  // namespace pb
