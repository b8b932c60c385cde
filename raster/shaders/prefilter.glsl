// What the filters of cube maps have in common: one dispatch fills one level of some faces of one cube.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kFilterTargetImage) writeonly uniform image2DArray target;
// x first layer of the cube, y its faces to be filled (4 bits each), z edge of the level in texels, w source level
layout(location = 0) uniform ivec4 job;

// (x, y, face) of this invocation's texel; x beyond the level for those that have none.
ivec3 targetTexel() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  return ivec3(p, (job.y >> (4 * int(gl_WorkGroupID.z))) & 15);
}

bool isOutside(ivec3 texel) { return texel.x >= job.z || texel.y >= job.z; }

vec2 texelCentre(ivec2 p, float size) { return (2.0f * vec2(p) + vec2(1.0f)) / size - vec2(1.0f); }

void store(ivec3 texel, vec3 radiance) { imageStore(target, ivec3(texel.xy, job.x + texel.z), vec4(radiance, 1.0f)); }
