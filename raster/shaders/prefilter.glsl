// What the filters of cube maps have in common: one dispatch fills one level of some faces of one cube.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"

#include "raster/shaders/store_texel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// x faces to be filled (4 bits each), y edge of the level in texels, z source level, the one before
layout(location = 0) uniform ivec3 job;

// (x, y, face) of this invocation's texel; x beyond the level for those that have none.
ivec3 targetTexel() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  return ivec3(p, (job.x >> (4 * int(gl_WorkGroupID.z))) & 15);
}

bool isOutside(ivec3 texel) { return texel.x >= job.y || texel.y >= job.y; }

vec2 texelCentre(ivec2 p, float size) { return (2.0f * vec2(p) + vec2(1.0f)) / size - vec2(1.0f); }

