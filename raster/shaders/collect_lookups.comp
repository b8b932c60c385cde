#version 450 core
// Makes lists of captured faces' unsettled texels that surfaces of one group of lookups each were drawn to (RECORDS_LOOKUP of
// scene.frag).
#define PB_FUNC
#include "raster/shaders/blocks.glsl"
#include "raster/shaders/lookup_records.glsl"

// Each invocation goes along a piece of a row, so that most neighbours on the list are neighbours in the capture. What is
// dear is what is done with the texels found: llvmpipe does it for a whole vector of invocations if one of them needs it.
const int kColumns = 8;
const int kTileColumns = 8 * kColumns;  // of a work group
const int kTileRows = 8;

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kLookupCaptureUnit) uniform sampler2DArray capture;
#ifndef MIRROR_RECORDS
layout(binding = kLookupTargetUnit) uniform sampler2D targets[kRecordTexels];
layout(rgba32f, binding = kLookupRecordImage) writeonly uniform imageBuffer records;
#endif
layout(std430, binding = kLookupScanBlock) readonly buffer LookupScanBlock { LookupScan scans[]; };
// x first scan, y the one after the last, z work groups of all of them
layout(location = 0) uniform ivec3 job;

void main() {
  int workGroup = int(gl_NumWorkGroups.x * gl_WorkGroupID.y + gl_WorkGroupID.x);
  if (workGroup >= job.z) return;
  int number = job.x;
  while (number + 1 < job.y && scans[number + 1].work.x <= workGroup) ++number;
  LookupScan scan = scans[number];
  int tile = workGroup - scan.work.x;
  int tilesAcross = (scan.area.z + kTileColumns - 1) / kTileColumns;
  ivec2 first = ivec2(kTileColumns * (tile % tilesAcross) + kColumns * int(gl_LocalInvocationID.x),
                      kTileRows * (tile / tilesAcross) + int(gl_LocalInvocationID.y));
  ivec2 last = ivec2(scan.area.z, scan.area.w) - ivec2(1);
  ivec2 corner = ivec2(scan.area.x, scan.area.y);
  uint found = 0u;
  for (int column = 0; column < kColumns; ++column) {
    ivec2 p = first + ivec2(column, 0);
    ivec2 inside = min(p, last);
    float alpha = texelFetch(capture, ivec3(inside + corner, scan.lookedFor.x), 0).w;
    if (p == inside && alpha == float(scan.lookedFor.y)) found |= 1u << column;
  }
  if (found == 0u) return;
  uint place = uint(scan.lookedFor.w) + addToList(uint(scan.lookedFor.z), uint(bitCount(found)));
  while (found != 0u) {
    ivec2 p = first + ivec2(findLSB(found), 0) + corner;
    found &= found - 1u;
#ifndef MIRROR_RECORDS
    for (int i = 0; i < kRecordTexels; ++i)
      imageStore(records, kRecordTexels * int(place) + i, texelFetch(targets[i], p, 0));
#endif
    entries[3u * place] = uint(p.x) | (uint(p.y) << 14u) | (uint(scan.lookedFor.x) << 28u);
    ++place;
  }
}
