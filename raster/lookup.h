// Lookups: how a shaded point turns a reflected or refracted direction into a texel of a probe's map.
//
// Points look along a direction from where they are; a lookup turns that into a direction from the probe, for reflected
// and refracted rays alike.
//
// Adding one: a file in raster/lookup/ with a Lookup, and its line in raster/lookup/lookups.def.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raster/technique.h"

namespace pb {

// Reads the parameters of a lookup's spec; messages name it. Name them all, then finish().
SpecReader lookupReader(const Spec& spec);

// Of lookups without parameters.
std::string noLookupDefines(const Spec& spec);

struct Lookup {
  std::string name;
  std::string parameters;   // for `axes info`: "steps = ..., 1 to 32, default 8"; "" for none
  std::string description;  // one sentence
  std::string source;       // paper, or who does it like that
  // Validates the parameters and gives them to `glsl` as defines; throws an input Error.
  std::string (*defines)(const Spec&) = noLookupDefines;
  // The function that raster/shaders/lookup_direction.glsl declares; "" for lookups that take directions as they are.
  std::string_view glsl = "";
  bool readsDistances = false;  // of what the probe's map shows
  // What is looked up depends on the ray and the probe, not on what maps show, so that iterations can look it up again
  // (raster/lookup_records.h).
  bool keepsDirections = false;
  bool isPlanar = false;      // reflections of flat reflectors come from mirrored views (raster/planar.h)
  bool isSingleView = false;  // probes capture one view instead of six faces
};

const std::vector<Lookup>& lookups();

// Throws an input Error for an unknown lookup or parameter.
const Lookup& lookupOf(const Spec& spec);
void checkLookup(const Spec& spec);

// Of the shader variants that look up maps: the lookup's own, and what radiance_lookup.glsl has to know of it.
std::string lookupDefines(const Spec& spec);

// Whether shaders read where the probe and its proxies are.
bool readsProbe(const Technique& technique);

// Whether probes keep the distances of what they capture.
bool needsDistances(const Technique& technique);

// Views that a probe captures: the six faces of a cube, or one.
int viewsOfProbe(const Technique& technique);

// How the maps of probes are filtered: single views aren't.
ProbeFilter mapFilter(const Technique& technique);

}  // namespace pb
