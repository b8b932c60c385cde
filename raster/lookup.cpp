#include "raster/lookup.h"

#include <algorithm>

#include "scenes/error.h"

namespace pb {

#define LOOKUP(function) Lookup function();
#include "raster/lookup/lookups.def"
#undef LOOKUP

const std::vector<Lookup>& lookups() {
  static const std::vector<Lookup> table = {
#define LOOKUP(function) function(),
#include "raster/lookup/lookups.def"
#undef LOOKUP
  };
  return table;
}

SpecReader lookupReader(const Spec& spec) { return {spec, "lookup '" + printSpec(spec) + "'"}; }

std::string noLookupDefines(const Spec& spec) {
  lookupReader(spec).finish();
  return "";
}

const Lookup& lookupOf(const Spec& spec) {
  const auto found = std::ranges::find(lookups(), spec.name, &Lookup::name);
  if (found == lookups().end()) {
    std::vector<std::string> names;
    for (const Lookup& lookup : lookups()) names.push_back(lookup.name);
    throwInputError("lookup {}", unknownMessage(spec.name, names));
  }
  return *found;
}

void checkLookup(const Spec& spec) { lookupOf(spec).defines(spec); }

std::string lookupDefines(const Spec& spec) {
  const Lookup& lookup = lookupOf(spec);
  std::string defines = lookup.defines(spec);
  if (!lookup.glsl.empty()) defines += "#define LOCAL_LOOKUP\n";
  if (lookup.readsDistances) defines += "#define READS_DISTANCES\n";
  if (lookup.isSingleView) defines += "#define SINGLE_VIEW\n";
  return defines;
}

bool readsProbe(const Technique& technique) { return !lookupOf(technique.lookup).glsl.empty(); }

bool needsDistances(const Technique& technique) { return lookupOf(technique.lookup).readsDistances; }

int viewsOfProbe(const Technique& technique) { return lookupOf(technique.lookup).isSingleView ? 1 : 6; }

ProbeFilter mapFilter(const Technique& technique) {
  return lookupOf(technique.lookup).isSingleView ? ProbeFilter::none : technique.filter;
}

}  // namespace pb
