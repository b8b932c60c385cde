// Where in a probe's map a point looks up what it sees along a direction: lookupDirection(), the code of the technique's
// lookup (raster/lookup/), which stands at the end of the shader.
//
// Variants by defines: LOCAL_LOOKUP if the lookup has such code, else directions are taken as they are; READS_DISTANCES if
// that reads how far away what the map shows is.

#ifdef LOCAL_LOOKUP
layout(std140, binding = kProbeBlock) uniform ProbeBlock { ProbeConstants probeConstants; };
#ifdef BLENDED_PROBES
layout(std140, binding = kSecondProbeBlock) uniform SecondProbeBlock { ProbeConstants secondProbeConstants; };
#endif
#endif

// `from` is a point of the surface, d a unit vector, both in world space. Returns a direction from the probe, of any length;
// of a single view (SINGLE_VIEW) coordinates in it, from 0 to 1. `depths` are reciprocals of distances along the axis of the
// face, times the near plane, 0 for what is infinitely far away.
#ifdef READS_DISTANCES
layout(binding = kProbeDepthUnit) uniform samplerCube probeDepths;
#ifdef BLENDED_PROBES
layout(binding = kSecondProbeDepthUnit) uniform samplerCube secondProbeDepths;
#endif
vec3 lookupDirection(ProbeConstants p, samplerCube depths, vec3 from, vec3 d);
#define FIRST_DIRECTION(from, d) lookupDirection(probeConstants, probeDepths, from, d)
#define SECOND_DIRECTION(from, d) lookupDirection(secondProbeConstants, secondProbeDepths, from, d)
#elif defined(LOCAL_LOOKUP)
vec3 lookupDirection(ProbeConstants p, vec3 from, vec3 d);
#define FIRST_DIRECTION(from, d) lookupDirection(probeConstants, from, d)
#define SECOND_DIRECTION(from, d) lookupDirection(secondProbeConstants, from, d)
#else
#define FIRST_DIRECTION(from, d) d
#define SECOND_DIRECTION(from, d) d
#endif
