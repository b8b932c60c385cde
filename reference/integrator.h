// Radiance along one ray: paths of reflections, refractions and, for global illumination, diffuse bounces.
#pragma once

#include <optional>

#include "reference/path.h"

namespace pb {

// An unbiased estimate of the radiance that arrives at the ray's origin from its direction. conePerMetre is the width
// of the sample's cone per metre of path (shading/texture.glsl). Nothing is clamped.
//
// Under local transport a hit adds the closed form of its diffuse base (localRadiance(); with shadow rays if the scene
// casts shadows), and the path goes on by the specular lobe alone. Under traced transport it goes on by either lobe,
// and every spread lobe looks for the environment, for emitting triangles and for punctual lights. What a spread lobe
// finds of the first two by chance is combined with the light samples by multiple importance sampling, each lobe on its
// own, so that the limits on bounces hold for each.
//
// After `depth` specular hits the path takes the environment, unoccluded. After `diffuseDepth` diffuse bounces the next
// diffuse hit's ray still sees the environment and what emits, but no more reflected light.
//
// Where a surface's opacity is below 1 the path goes straight on with the rest of the weight; that is no hit in the
// sense of the limits.
//
// Without a depth, Russian roulette ends specular paths from hit 17 on; they go on with probability p, the largest
// channel of the hit's weight but at most 0.95, weighted by 1 / p. Variance of a chain that ends after n > 16 hits with
// radiance L weighted T: T^2 L^2 (0.95^-(n-16) - 1) for T near 1, which is 1.3 L^2 for n = 32, and less than T L^2 for
// a small T. Between mirrors that reflect more than sqrt(0.95) for ever the mean stays right but the variance has no
// bound. Diffuse bounces are thinned in the same way from the fifth on.
//
// Directions follow the smooth normal, so that near a silhouette one may point under the triangle. Such a ray goes on
// behind it: out of a closed single-sided mesh it comes through the back faces, which are not there, much as if it had
// grazed the smooth surface; a double-sided mesh it meets from inside. Refractive media are kept by the side of the
// triangle on which a ray goes on, so that such a ray, too, knows what it is inside of.
PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre,
                     const ReferenceSettings& settings, Sampler& sampler);

}  // namespace pb
