#version 450 core
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#ifdef SHADOW_PASS
#include "raster/shaders/shadow_projection.glsl"
layout(std140, binding = kShadowPassBlock) uniform ShadowPassBlock { ShadowFace shadowFace; };
#endif

layout(location = 0) in vec3 objectPosition;
layout(location = 1) in vec3 objectNormal;
layout(location = 0) out vec3 worldPosition;
layout(location = 1) out vec3 worldNormal;
#ifdef ATTRIBUTES
layout(location = 2) in vec4 objectTangent;
layout(location = 3) in vec4 vertexUv;
layout(location = 4) in vec4 vertexColor;
layout(location = 5) in float vertexUvPerMetre;
layout(location = 2) out vec4 worldTangent;
layout(location = 3) out vec4 uv;
layout(location = 4) out vec4 color;
layout(location = 5) out float uvPerMetre;
#endif
#ifdef REFRACTION_TWO_INTERFACE
layout(location = 6) in float objectInwardDistance;
layout(location = 6) out float inwardDistance;
#endif

// Variants must cover the same pixels.
invariant gl_Position;

void main() {
  mat4 m = instance.worldFromObject;
  // The order of operations in GLM's mat4 * vec4, which places the reference's triangles.
  precise vec4 world = (m[0] * objectPosition.x + m[1] * objectPosition.y) + (m[2] * objectPosition.z + m[3]);
  worldPosition = vec3(world);
  worldNormal = mat3(instance.normalMatrix) * objectNormal;
#ifdef ATTRIBUTES
  worldTangent = vec4(mat3(m) * vec3(objectTangent), objectTangent.w * instance.values.w);
  uv = vertexUv;
  color = vertexColor;
  uvPerMetre = vertexUvPerMetre * instance.values.x;
#endif
#ifdef REFRACTION_TWO_INTERFACE
  inwardDistance = objectInwardDistance * length(mat3(m) * objectNormal);
#endif
#ifdef SHADOW_PASS
  gl_Position = shadowClipPosition(shadowFace, worldPosition);
#else
  gl_Position = clipFromWorldPosition(pass.view, worldPosition);
#ifdef CLIP_PLANE
  gl_ClipDistance[0] = dot(vec3(pass.clip), worldPosition) + pass.clip.w;
#endif
#endif
}
