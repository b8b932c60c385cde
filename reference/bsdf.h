// What a surface does with light: the lobes of its material, their sampling and their densities.
//
// Directions are unit vectors in world space that point away from the surface. A value is BSDF (1/sr) times the cosine
// to the light; a sample's weight is value / density; a density is per steradian and includes the probability of having
// chosen the lobe. sample() and evaluate() are pairs: what evaluate() says is what sample() does.
//
// Radiance is not scaled by the square of the refractive index when light enters or leaves a medium: the factors of
// entering and leaving cancel for a viewer outside, and for one inside what is computed is L / n^2, which has no seam.
//
// The diffuse base under a coat keeps the light that the coat doesn't reflect towards the viewer, as in the raster.
// That is not reciprocal, but conserves energy for every direction of view.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "reference/renderer.h"
#include "reference/sampler.h"
#include "scenes/snapshot.h"

namespace pb {

// The indices of refraction on both sides of a surface, seen along the path.
struct InterfaceIor {
  glm::vec3 relativeIor{1.0f};  // n behind over n before, by channel
  int channel = -1;             // the only one that the path carries; -1: all

  bool disperses() const { return relativeIor.x != relativeIor.y || relativeIor.z != relativeIor.y; }
};

enum class Lobe {
  straight,  // past the surface, where it isn't there (opacity below 1)
  specular,  // reflected or refracted, perfectly smooth or rough
  diffuse
};

struct ScatteredRay {
  glm::vec3 direction;
  glm::vec3 weight;
  float pdf;  // 0: one of finitely many directions, that no light sample can meet
  Lobe lobe;
  int channel;  // that the path carries from here on, -1 for all
};

// All ways on from a surface where they are finitely many. Each has its share of the light for a weight.
class Ways {
 public:
  void add(const ScatteredRay& way) { ways_[size_++] = way; }
  std::span<const ScatteredRay> all() const { return {ways_.data(), size_}; }

 private:
  std::array<ScatteredRay, 5> ways_{};  // straight on, reflected, and refracted in three colours
  std::size_t size_ = 0;
};

// Values towards one direction, and the densities with which sample() would have found it by each lobe.
struct LobeValues {
  glm::vec3 diffuse{0.0f};
  glm::vec3 specular{0.0f};
  float diffusePdf = 0.0f;
  float specularPdf = 0.0f;
};

class Bsdf {
 public:
  // Under local transport the diffuse lobe is left out: it needs no rays. The surface must outlive this object.
  Bsdf(const shading::Surface& surface, const glm::vec3& toViewer, const InterfaceIor& refraction,
       DiffuseTransport diffuse);

  // What sample() chooses from, if that needs no directions to be drawn; none: the path ends here.
  std::optional<Ways> ways() const;

  // Draws random numbers only where there is more than one way to go. nullopt: the path ends here.
  std::optional<ScatteredRay> sample(Sampler& sampler) const;

  // Without perfectly smooth lobes and, where a rough surface splits white light by dispersion, without refraction.
  LobeValues evaluate(const glm::vec3& toLight) const;

  // Whether evaluate() can be anything but 0.
  bool isSpread() const { return diffuse_ > 0.0f || (rough_ && specular_ > 0.0f); }

 private:
  glm::vec3 specularAlbedo() const;
  shading::SpecularWeights microfacetWeights(float cosine) const;
  std::optional<ScatteredRay> sampleDiffuse(Sampler& sampler) const;
  std::optional<ScatteredRay> sampleSpecular(Sampler& sampler) const;
  ScatteredRay reflect(const glm::vec3& h, float cosine, const glm::vec3& weight, float probability) const;
  bool splitsChannels() const;
  std::optional<ScatteredRay> refract(const glm::vec3& h, float cosine, const glm::vec3& weight, float probability,
                                      int channel) const;
  void addRefracted(const glm::vec3& weight, Ways& ways) const;
  void evaluateReflection(const glm::vec3& reflected, bool throughWall, LobeValues& values) const;
  void evaluateRefraction(const glm::vec3& toLight, LobeValues& values) const;
  float visibleNormalPdf(const glm::vec3& h, float VoH) const;

  const shading::Surface& s_;
  InterfaceIor refraction_;
  bool matched_;  // refracts between equal media: no interface
  bool rough_;
  shading::Frame frame_;  // around the shading normal; of spread lobes only
  glm::vec3 straightOn_;  // past the surface
  glm::vec3 toViewer_;    // of rough surfaces: at least a little above the horizon
  float NoV_;
  glm::vec3 diffuseReflectance_{0.0f};
  // Probabilities of the lobes.
  float straight_ = 0.0f, specular_ = 0.0f, diffuse_ = 0.0f;
};

}  // namespace pb
