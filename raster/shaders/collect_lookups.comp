#version 450 core
// Makes a list of a captured face's unsettled texels that surfaces of one group of lookups were drawn to (RECORDS_LOOKUP of
// scene.frag).
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/lookup_records.glsl"

// Each invocation goes along a piece of a row, so that most neighbours on the list are neighbours in the capture. What is
// dear is what is done with the texels found: llvmpipe does it for a whole vector of invocations if one of them needs it.
const int kColumns = 8;

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kLookupCaptureUnit) uniform sampler2DArray capture;
#ifndef MIRROR_RECORDS
layout(binding = kLookupTargetUnit) uniform sampler2D targets[kRecordTexels];
layout(rgba32f, binding = kLookupRecordImage) writeonly uniform imageBuffer records;
#endif
// x y first texel, z w number of columns and rows
layout(location = 0) uniform ivec4 area;
// x face, y alpha of the texels, z the list
layout(location = 1) uniform ivec3 job;

void main() {
  ivec2 first = ivec2(kColumns * gl_GlobalInvocationID.x, gl_GlobalInvocationID.y);
  ivec2 last = ivec2(area.z, area.w) - ivec2(1);
  uint found = 0u;
  for (int column = 0; column < kColumns; ++column) {
    ivec2 p = first + ivec2(column, 0);
    ivec2 inside = min(p, last);
    float alpha = texelFetch(capture, ivec3(inside + area.xy, job.x), 0).w;
    if (p == inside && alpha == float(job.y)) found |= 1u << column;
  }
  if (found == 0u) return;
  uint place = addToList(uint(job.z), uint(bitCount(found)));
  while (found != 0u) {
    ivec2 p = first + ivec2(findLSB(found), 0) + area.xy;
    found &= found - 1u;
#ifndef MIRROR_RECORDS
    for (int i = 0; i < kRecordTexels; ++i)
      imageStore(records, kRecordTexels * int(place) + i, texelFetch(targets[i], p, 0));
#endif
    entries[3u * place] = uint(p.x) | (uint(p.y) << 14u) | (uint(job.x) << 28u);
    ++place;
  }
}
