// What texels of captures show as a function of what a probe's map shows: rest + weight * radiance of the map's level
// `lod` along `direction`. The records of one captured probe stand in one buffer, in a region for each group of lookups, in
// no particular order; what is bound is one region.
//
// Variant by a define: MIRROR_RECORDS for groups of mirrors that are everywhere the same, of which direction and cosine to
// the viewer say all: rest and level are 0, and the weight follows from the material. These stay in the texture that they
// were drawn to; lists of them are of texels alone.

const int kRecordTexels = 3;  // direction and level, weight, rest

// A list of the records of one region that a later bounce iteration has to look up. x y z: work groups that do, as
// glDispatchComputeIndirect reads them; w: how many records are on it.
layout(std430, binding = kLookupListBlock) buffer LookupListBlock { uvec4 lists[]; };

// Three for each record: its texel (x, y and face: 14, 14 and 3 bits), then places for the entries of lists after the
// first, which are all records of the region: one for lists of even and one for lists of odd number.
layout(std430, binding = kLookupEntryBlock) buffer LookupEntryBlock { uint entries[]; };

const uint kRecordsPerGroup = 512u;
uint groupsOf(uint records) { return (records + kRecordsPerGroup - 1u) / kRecordsPerGroup; }

// Returns the first entry's place on the list.
uint addToList(uint list, uint count) {
  uint place = atomicAdd(lists[list].w, count);
  uint more = groupsOf(place + count) - groupsOf(place);
  if (more > 0u) atomicAdd(lists[list].x, more);
  return place;
}
