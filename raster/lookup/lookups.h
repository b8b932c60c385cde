// One function a lookup: each in its own file beside this one.
#pragma once

#include "raster/lookup.h"

namespace pb {

// Reads the parameters of a lookup's spec; messages name it.
SpecReader lookupReader(const Spec& spec);

Lookup infiniteLookup();
Lookup sphereProxyLookup();
Lookup boxProxyLookup();
Lookup distanceImpostorLookup();
Lookup planarLookup();
Lookup singleViewLookup();

}  // namespace pb
