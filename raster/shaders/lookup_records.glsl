// What texels of captures show as a function of what a probe's map shows: rest + weight * radiance of the map's level
// `lod` along `direction`. The records of one captured probe stand in one buffer, in a region for each probe looked up,
// in no particular order; what is bound is one region.

struct LookupRecord {
  vec3 rest;
  uint texel;  // x, y and face: 14, 14 and 3 bits
  vec3 weight;
  float lod;
  vec3 direction;
  float unused;
};
layout(std430, binding = kLookupRecordBlock) buffer LookupRecordBlock { LookupRecord records[]; };

// A list of the records of one region that a later bounce iteration has to look up. x y z: work groups that do, as
// glDispatchComputeIndirect reads them; w: how many records are on it.
layout(std430, binding = kLookupListBlock) buffer LookupListBlock { uvec4 lists[]; };

// The entries of lists after the first, which are all records of the region: two places for each record, for lists of
// even and of odd number.
layout(std430, binding = kLookupIndexBlock) buffer LookupIndexBlock { uint entries[]; };

const uint kRecordsPerGroup = 64u;

// Returns the entry's place on the list.
uint addToList(uint list) {
  uint place = atomicAdd(lists[list].w, 1u);
  if (place % kRecordsPerGroup == 0u) atomicAdd(lists[list].x, 1u);
  return place;
}
