#version 450 core
// Makes a list of a captured face's unsettled texels that surfaces with a lookup were drawn to (RECORDS_LOOKUP of
// scene.frag).
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/lookup_records.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kLookupRestUnit) uniform sampler2D restAndMarker;
layout(binding = kLookupWeightUnit) uniform sampler2D weightAndLod;
layout(binding = kLookupDirectionUnit) uniform sampler2D directionAndUnsettled;
// x y first texel, z w number of columns and rows
layout(location = 0) uniform ivec4 area;
// x face, y marker of the texels, z the list
layout(location = 1) uniform ivec3 job;

void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  if (p.x >= area.z || p.y >= area.w) return;
  p += area.xy;
  vec4 rest = texelFetch(restAndMarker, p, 0);
  if (int(rest.w) != job.y) return;
  vec4 direction = texelFetch(directionAndUnsettled, p, 0);
  if (direction.w == 0.0f) return;
  uint record = addToList(uint(job.z));
  vec4 weight = texelFetch(weightAndLod, p, 0);
  records[record].rest = vec3(rest);
  records[record].texel = uint(p.x) | (uint(p.y) << 14u) | (uint(job.x) << 28u);
  records[record].weight = vec3(weight);
  records[record].lod = weight.w;
  records[record].direction = vec3(direction);
}
