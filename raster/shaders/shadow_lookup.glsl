// How much of a punctual light arrives, by shadow maps.
//
// Depths are compared before they are filtered (Reeves, Salesin and Cook, "Rendering Antialiased Shadows with Depth Maps",
// 1987), bilinearly from 2 x 2 texels: a shadow's edge is a ramp one texel wide.
#include "raster/shaders/shadow_projection.glsl"

layout(std430, binding = kShadowBlock) readonly buffer ShadowBlock { ShadowFace shadowFaces[]; };
layout(binding = kShadowUnit) uniform sampler2DArray shadowDepths;

// Of rounding and of the snapping of vertices to 1/256 texel, as a share of the distance and of the bias.
const float kShadowRounding = 2e-5f;
const float kShadowSnapping = 1.0f / 64.0f;

// Normal of the triangle, either side's.
vec3 triangleNormal() { return safeNormalize(cross(dFdx(worldPosition), dFdy(worldPosition))); }

// What the surface's depth grows along forward, in metres, to the farthest of the four texels: less than a texel away in
// both directions. n: the triangle's normal.
float shadowBias(ShadowFace face, vec3 p, vec3 n, float distanceAlong, float texel) {
  bool parallel = face.values.x > 0.5f;
  vec3 ray = parallel ? vec3(face.view.forward) : (p - vec3(face.view.origin)) / distanceAlong;
  float slope = (abs(dot(n, vec3(face.view.right))) + abs(dot(n, vec3(face.view.down)))) / max(abs(dot(n, ray)), 1e-4f);
  float reach = parallel ? face.values.y : distanceAlong;
  return (1.0f + kShadowSnapping) * slope * texel * (parallel ? 1.0f : distanceAlong) + kShadowRounding * reach;
}

float litTexel(ivec3 texel, int size, float depth) {
  ivec2 inside = clamp(ivec2(texel.x, texel.y), ivec2(0), ivec2(size - 1));
  return texelFetch(shadowDepths, ivec3(inside, texel.z), 0).x <= depth ? 1.0f : 0.0f;
}

// 0 in shadow, 1 lit. light.cone: z first face, w number of faces; n: triangleNormal().
float lightVisibility(Light light, vec3 p, vec3 n) {
  int layer = int(light.cone.z);
  if (light.cone.w > 1.5f) layer += cubeFaceOf(p - vec3(light.positionKind));
  ShadowFace face = shadowFaces[layer];
  float distanceAlong = dot(p - vec3(face.view.origin), vec3(face.view.forward));
  bool parallel = face.values.x > 0.5f;
  if (!parallel && distanceAlong <= face.view.origin.w) return 1.0f;
  int size = textureSize(shadowDepths, 0).x;
  float bias = shadowBias(face, p, n, distanceAlong, 2.0f / float(size));
  vec4 clip = shadowClipPosition(face, p);
  float depth = parallel ? clip.z + bias / face.values.y : clip.z / max(distanceAlong - bias, 1e-20f);
  vec2 at = (0.5f * vec2(clip.x, clip.y) / clip.w + vec2(0.5f)) * float(size) - vec2(0.5f);
  vec2 corner = floor(at);
  vec2 f = at - corner;
  ivec3 i = ivec3(ivec2(corner), layer);
  float top = mix(litTexel(i, size, depth), litTexel(i + ivec3(1, 0, 0), size, depth), f.x);
  float bottom = mix(litTexel(i + ivec3(0, 1, 0), size, depth), litTexel(i + ivec3(1, 1, 0), size, depth), f.x);
  return mix(top, bottom, f.y);
}
