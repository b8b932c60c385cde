#include "raster/lookup.h"

#include <algorithm>

#include "raster/lookup/lookups.h"
#include "scenes/error.h"

namespace pb {

SpecReader lookupReader(const Spec& spec) { return {spec, "lookup '" + printSpec(spec) + "'"}; }

const std::vector<Lookup>& lookups() {
  static const std::vector<Lookup> table = {infiniteLookup(),         sphereProxyLookup(), boxProxyLookup(),
                                            distanceImpostorLookup(), planarLookup(),      singleViewLookup()};
  return table;
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

bool needsDistances(const Technique& technique) { return lookupOf(technique.lookup).readsDistances; }

int viewsOfProbe(const Technique& technique) { return lookupOf(technique.lookup).isSingleView ? 1 : 6; }

ProbeFilter mapFilter(const Technique& technique) {
  return lookupOf(technique.lookup).isSingleView ? ProbeFilter::none : technique.filter;
}

}  // namespace pb
