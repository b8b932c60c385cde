#include "reference/integrator.h"

namespace pb {

PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre,
                     const ReferenceSettings& settings, Sampler& sampler) {
  BasicPath<NoRayLog> path(scene, primary, conePerMetre, settings);
  path.toTheEnd(sampler);
  return path.result();
}

}  // namespace pb
