#version 450 core
// Looks the records of a list up again. Texels that are settled leave the list: what they show was settled itself.
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/lookup_records.glsl"
#include "raster/shaders/settled.glsl"

layout(local_size_x = 512) in;
layout(binding = kProbeUnit) uniform samplerCube probe;
layout(binding = kLookupTargetImage) writeonly uniform image2DArray target;
#ifdef MIRROR_RECORDS
layout(binding = kLookupTargetUnit) uniform sampler2DArray directionsAndCosines;
#else
layout(rgba32f, binding = kLookupRecordImage) readonly uniform imageBuffer records;
#endif
// x the list, y the list for the next iteration (kNoList: there is none), z number of the list in the region
layout(location = 0) uniform uvec3 job;
// x largest radiance that the format holds, y how much of the map is settled
layout(location = 1) uniform vec2 values;

const uint kNoList = 0xffffffffu;

struct LookupRecord {
  vec3 direction;
  float lod;
  vec3 weight;
  vec3 rest;
};

#ifdef MIRROR_RECORDS
#include "raster/shaders/fresnel_law.glsl"

LookupRecord recordAt(int record, ivec3 texel) {
  vec4 directionAndCosine = texelFetch(directionsAndCosines, texel, 0);
  MaterialConstants m = material;
  m.kind.x = kSurfaceMirror;
  m.alpha.x = kAlphaOpaque;
  Surface s = makeSurface(m, vec3(0.0f), vec3(0.0f), vec4(1.0f), vec4(1.0f), vec4(1.0f), vec4(1.0f), vec4(1.0f));
  vec3 weight = specularReflectance(s, directionAndCosine.w, kFresnelLaw);
  return LookupRecord(vec3(directionAndCosine), 0.0f, weight, vec3(0.0f));
}
#else
LookupRecord recordAt(int record, ivec3 texel) {
  int first = kRecordTexels * record;
  vec4 directionAndLod = imageLoad(records, first);
  vec4 weight = imageLoad(records, first + 1);
  vec4 rest = imageLoad(records, first + 2);
  return LookupRecord(vec3(directionAndLod), directionAndLod.w, vec3(weight), vec3(rest));
}
#endif

void main() {
  uint place = gl_GlobalInvocationID.x;
  if (place >= lists[job.x].w) return;
  uint record = place;
  if (job.z > 0u) record = entries[3u * record + 1u + (job.z & 1u)];
  uint packedTexel = entries[3u * record];
  ivec3 p = ivec3(int(packedTexel & 16383u), int((packedTexel >> 14u) & 16383u), int(packedTexel >> 28u));
  LookupRecord r = recordAt(int(record), p);
  vec4 texel = textureLod(probe, r.direction, r.lod);
  float unsettled = unsettledLookup(texel.w, values.y);
  vec3 radiance = min(r.rest + r.weight * vec3(texel), vec3(values.x));
  imageStore(target, p, vec4(radiance, unsettled));
  if (unsettled > 0.0f && job.y != kNoList) entries[3u * addToList(job.y, 1u) + 1u + ((job.z + 1u) & 1u)] = record;
}
