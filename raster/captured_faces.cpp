#include "raster/captured_faces.h"

#include "raster/culling.h"

namespace pb {
namespace {

constexpr int kTop = 2, kBottom = 3;

}  // namespace

FacePart capturedPart(CapturedFaces faces, int face) {
  const bool isSide = face != kTop && face != kBottom;
  switch (faces) {
    case CapturedFaces::all:
      return FacePart::whole;
    case CapturedFaces::noTopBottom:
      return isSide ? FacePart::whole : FacePart::nothing;
    case CapturedFaces::topHalf:
      return isSide ? FacePart::upperHalf : face == kTop ? FacePart::whole : FacePart::nothing;
  }
  return FacePart::whole;
}

int capturedFaceCount(CapturedFaces faces) {
  int count = 0;
  for (int face = 0; face < 6; ++face) count += capturedPart(faces, face) == FacePart::nothing ? 0 : 1;
  return count;
}

bool isOutsidePart(const Bounds& box, const shading::View& view, FacePart part) {
  if (part == FacePart::nothing) return true;
  return (part == FacePart::upperHalf && box.upper.y < view.origin.y) || isOutsideFrustum(box, view);
}

int rowsOf(FacePart part, int n) {
  if (part == FacePart::nothing) return 0;
  return part == FacePart::upperHalf ? n / 2 : n;
}

}  // namespace pb
