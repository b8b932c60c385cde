// Environments: radiance from infinitely far away in every direction.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace pb {

// Equal radiance from everywhere.
Environment makeConstantEnvironment(glm::vec3 radiance);

// The procedural sky that scenes without light and environment get: blue gradient, grey below, glow around the sun.
Environment makeProceduralSky();

// Ambient light computed from the gradient by quadrature.
Environment makeGradientEnvironment(const shading::Sky& sky);

// An equirectangular image resampled to six faces in GL order, averaging where these are coarser.
std::vector<ImageRgba> cubeFacesOf(const ImageRgba& equirectangular, int faceSize);

// Six square faces of one size in GL order, with the ambient light projected from them.
Environment makeCubeEnvironment(std::string name, std::vector<ImageRgba> faces);

// "sky" (procedural), "black", "white", "constant?r=..&g=..&b=..", a path of an equirectangular image (.exr, .hdr,
// ...), or six images "PREFIX{px,nx,py,ny,pz,nz}.EXT" written as one path with a '*' in the place of px..nz.
// Equirectangular images are resampled to cube faces; u = 0.5 is -Z, u grows towards +X, v = 0 is +Y.
// Values are repaired by repairRadiance().
Environment loadEnvironment(const std::string& text, std::vector<std::string>& warnings);

// "sky;sunset.exr@2;black@3.5": environments that follow each other, from 2 s and from 3.5 s on; the first one's time
// is 0. Throws an input Error for a later one without time.
struct TimedEnvironment {
  std::string text;  // for loadEnvironment()
  double timeSeconds = 0.0;
};
std::vector<TimedEnvironment> parseEnvironments(const std::string& text);
std::string printEnvironments(const std::vector<TimedEnvironment>& environments);

// Replaces what no light can be: NaN and negative values become 0; infinities and values above kLargestRadiance become
// the largest of the others. Each comes with a warning that counts them. Alpha becomes 1.
void repairRadiance(ImageRgba& image, const std::string& name, std::vector<std::string>& warnings);

// W/(sr m^2). The sun has 2e7; sums over millions of texels and products of two such numbers still fit into float.
inline constexpr float kLargestRadiance = 1e9f;

// Ambient light of six faces: projection onto spherical harmonics of bands 0 to 2 (Ramamoorthi and Hanrahan 2001).
shading::Ambient projectAmbient(const std::vector<ImageRgba>& faces);

// The same ambient radiance from all sides.
shading::Ambient constantAmbient(glm::vec3 radiance);

// Radiance in unit direction d, as both renderers see it.
glm::vec3 environmentRadiance(const Environment& environment, glm::vec3 d);

}  // namespace pb
