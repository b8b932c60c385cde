#version 450 core
// Looks the records of a list up again. Texels that are settled leave the list: what they show was settled itself.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/lookup_records.glsl"
#include "raster/shaders/settled.glsl"

layout(local_size_x = 64) in;
layout(binding = kProbeUnit) uniform samplerCube probe;
layout(binding = kLookupTargetImage) writeonly uniform image2DArray target;
// x the list, y the list for the next iteration (kNoList: there is none), z number of the list in the region
layout(location = 0) uniform uvec3 job;
// x largest radiance that the format holds, y how much of the map is settled
layout(location = 1) uniform vec2 values;

const uint kNoList = 0xffffffffu;

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= lists[job.x].w) return;
  uint record = place;
  if (job.z > 0u) record = entries[2u * record + (job.z & 1u)];
  LookupRecord r = records[record];
  vec4 texel = textureLod(probe, r.direction, r.lod);
  float unsettled = unsettledLookup(texel.w, values.y);
  vec3 radiance = min(r.rest + r.weight * vec3(texel), vec3(values.x));
  ivec3 p = ivec3(int(r.texel & 16383u), int((r.texel >> 14u) & 16383u), int(r.texel >> 28u));
  imageStore(target, p, vec4(radiance, unsettled));
  if (unsettled > 0.0f && job.y != kNoList) entries[2u * addToList(job.y) + ((job.z + 1u) & 1u)] = record;
}
