// The surroundings are what the probe captured, at the distances of its depth buffers.
#include <fmt/format.h>

#include "raster/lookup.h"

namespace pb {
namespace {

std::string defines(const Spec& spec) {
  SpecReader reader = lookupReader(spec);
  const int steps = reader.integer("steps", 0, 256, 8);
  const int secant = reader.integer("secant", 1, 32, 6);
  reader.finish();
  return fmt::format("#define LINEAR_STEPS {}\n#define SECANT_STEPS {}\n", steps, secant);
}

constexpr const char* kGlsl = R"glsl(
// x t, y excess there.
vec2 impostorSample(samplerCube depths, float near, vec3 from, vec3 far, float t) {
  vec3 direction = impostorDirection(from, far, t);
  return vec2(t, impostorExcess(direction, t, textureLod(depths, direction, 0.0f).x / near));
}

// The linear search finds the first interval in which the ray goes behind what was captured, the secant search the
// place in it. A ray that starts hidden from the probe counts from where it comes into sight.
vec3 impostorHit(samplerCube depths, float near, vec3 from, vec3 d) {
  vec3 far = length(from) * d;
  vec2 front = impostorSample(depths, near, from, far, 0.0f);
  vec2 behind = vec2(1.0f, 0.0f);
  for (int i = 1; i <= LINEAR_STEPS + 1; ++i) {
    vec2 here = impostorSample(depths, near, from, far, float(i) / float(LINEAR_STEPS + 1));
    if (behind.y > 0.0f) continue;
    if (front.y <= 0.0f && here.y > 0.0f) behind = here;
    else front = here;
  }
  if (behind.y <= 0.0f) return d;  // what the ray meets is infinitely far away, or hidden from the probe
  // Regula falsi. An end that stays counts half (Illinois), so that both move.
  float side = 0.0f;
  float t = impostorSecant(front, behind);
  for (int i = 1; i < SECANT_STEPS; ++i) {
    vec2 here = impostorSample(depths, near, from, far, t);
    if (here.y < 0.0f) {
      if (side < 0.0f) behind.y *= 0.5f;
      front = here;
    } else {
      if (side > 0.0f) front.y *= 0.5f;
      behind = vec2(here.x, max(here.y, 1e-20f));
    }
    side = here.y;
    t = impostorSecant(front, behind);
  }
  return impostorDirection(from, far, t);
}

vec3 lookupDirection(ProbeConstants p, samplerCube depths, vec3 from, vec3 d) {
  return impostorHit(depths, p.position.w, from - vec3(p.position), d);
}
)glsl";

}  // namespace

Lookup distanceImpostorLookup() {
  return {.name = "distance-impostor",
          .parameters =
              "steps = samples of the linear search, 0 to 256, default 8; secant = steps of the search between "
              "two of them, 1 to 32, default 6",
          .description = "where the ray goes behind what the probe captured, searched in its depth buffers",
          .source = "Szirmay-Kalos et al., Eurographics 2005",
          .defines = defines,
          .glsl = kGlsl,
          .readsDistances = true};
}

}  // namespace pb
