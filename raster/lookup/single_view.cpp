// One picture of a single direction instead of a cube map, and a mapping of texture coordinates and reflected
// direction.
#include "raster/lookup.h"

namespace pb {
namespace {

// Gives coordinates in the probe's one view in the place of a direction. Surfaces without tangents take the view's
// right as theirs, those without attributes the middle of their texture.
constexpr const char* kGlsl = R"glsl(
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d) {
  vec3 normal = gl_FrontFacing ? safeNormalize(worldNormal) : -safeNormalize(worldNormal);
  vec4 tangent = vec4(vec3(p.right), 1.0f);
  vec2 coordinates = vec2(0.5f);
#ifdef ATTRIBUTES
  if (worldTangent.w != 0.0f) tangent = worldTangent;
  coordinates = vec2(uv.x, uv.y);
#endif
  vec3 right = safeNormalize(vec3(tangent) - dot(vec3(tangent), normal) * normal);
  vec3 up = cross(normal, right) * tangent.w;
  return vec3(singleViewCoordinates(coordinates, vec2(dot(d, right), -dot(d, up))), 0.0f);
}
)glsl";

}  // namespace

Lookup singleViewLookup() {
  return {.name = "single-view",
          .parameters = "",
          .description =
              "one view of 90 degrees from the probe along its owners' mean normal, by texture coordinates and "
              "the reflected direction in tangent space",
          .source = "report of a heap of CRT monitors",
          .glsl = kGlsl,
          .isSingleView = true};
}

}  // namespace pb
