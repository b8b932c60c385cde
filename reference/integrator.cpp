#include "reference/integrator.h"

namespace pb {

PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre,
                     const ReferenceSettings& settings, Sampler& sampler) {
  return PathsOfRay(scene, primary, conePerMetre, settings).trace(sampler);
}

}  // namespace pb
