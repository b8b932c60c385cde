#include "reference/bsdf.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scenes/dfg_table.h"
#include "scenes/luminance.h"

namespace pb {
namespace {

constexpr glm::vec4 kExactFresnel(shading::kFresnelExact, 0.0f, 0.0f, 0.0f);

// Smooth and mapped normals may lean away from the viewer at silhouettes, where microfacets have no visible side. Rough
// lobes are those of a viewer this little above the horizon then.
constexpr float kLowestViewer = 1e-3f;

// Relative indices nearer to 1 neither reflect (F < 3e-9) nor spread light, and leave no half vector to compute with.
constexpr float kMatchedIor = 1e-4f;

bool isMatched(const shading::Surface& s, const InterfaceIor& refraction) {
  if (s.kind != shading::kSurfaceGlass || shading::isThinWalled(s)) return false;
  const glm::vec3 difference = glm::abs(refraction.relativeIor - 1.0f);
  return std::max({difference.x, difference.y, difference.z}) < kMatchedIor;
}

glm::vec3 raisedViewer(const shading::Frame& frame, const glm::vec3& toViewer) {
  glm::vec3 local = shading::toLocal(frame, toViewer);
  if (local.z >= kLowestViewer) return toViewer;
  local.z = kLowestViewer;
  return shading::toWorld(frame, glm::normalize(local));
}

// Malley's method with polar coordinates: density cos / pi.
glm::vec3 sampleCosine(const glm::vec2& u) {
  const float radius = std::sqrt(u.x), phi = 2.0f * shading::kPi * u.y;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(1.0f - u.x, 0.0f))};
}

// Probability of the first of two ways; 0 if neither leads anywhere.
float share(float first, float second) { return first > 0.0f ? first / (first + second) : 0.0f; }

float reflectionProbability(const shading::SpecularWeights& weights) {
  return share(luminance(weights.reflection), luminance(weights.refraction));
}

// d(half vector) / d(refracted direction): Walter et al. 2007, eq. 17.
float refractionJacobian(float VoH, float LoH, float relativeIor) {
  const float sum = VoH + relativeIor * LoH;
  return relativeIor * relativeIor * std::abs(LoH) / std::max(sum * sum, 1e-12f);
}

// One channel with probability in proportion to its weight, which takes up the probability.
int chooseChannel(glm::vec3& weight, float u) {
  const float sum = weight.x + weight.y + weight.z;
  const int channel = u * sum < weight.x ? 0 : (u * sum < weight.x + weight.y ? 1 : 2);
  weight = glm::vec3(0.0f);
  weight[channel] = sum;
  return channel;
}

}  // namespace

Bsdf::Bsdf(const shading::Surface& surface, const glm::vec3& toViewer, const InterfaceIor& refraction,
           DiffuseTransport diffuse)
    : s_(surface),
      refraction_(refraction),
      matched_(isMatched(surface, refraction)),
      rough_(surface.alpha > 0.0f && shading::isSpecular(surface) && !matched_),
      straightOn_(-toViewer),
      toViewer_(toViewer),
      NoV_(std::max(glm::dot(surface.normal, toViewer), 0.0f)) {
  straight_ = 1.0f - s_.opacity;
  if (s_.opacity == 0.0f) return;
  const bool traced = diffuse == DiffuseTransport::traced && s_.kind != shading::kSurfaceUnlit;
  if (rough_ || traced) frame_ = shading::makeFrame(s_.normal);
  if (rough_) {
    toViewer_ = raisedViewer(frame_, toViewer);
    NoV_ = glm::dot(s_.normal, toViewer_);
  }
  if (traced) {
    diffuseReflectance_ = shading::diffuseAlbedo(s_) * (1.0f - coatAlbedo(s_, toViewer_));
    diffuse_ = s_.opacity * luminance(diffuseReflectance_);
  }
  // Of a choice between one thing only the albedo doesn't matter.
  if (shading::isSpecular(s_))
    specular_ = straight_ + diffuse_ > 0.0f ? s_.opacity * luminance(specularAlbedo()) : 1.0f;
  const float total = straight_ + specular_ + diffuse_;
  if (!(total > 0.0f)) return;
  straight_ /= total;
  specular_ /= total;
  diffuse_ /= total;
}

// Only how good the choice of lobes is depends on this, not what their mean is.
glm::vec3 Bsdf::specularAlbedo() const {
  if (!rough_ || s_.kind == shading::kSurfaceGlass) {
    const shading::SpecularWeights weights = microfacetWeights(NoV_);
    return weights.reflection + weights.refraction;
  }
  const shading::sampler2D table{&dfgTable(shading::kGeometrySmithCorrelated).levels};
  const glm::vec2 dfg = shading::surfaceDfg(s_, table, NoV_);
  return dfg.x * shading::specularF0(s_) + dfg.y * shading::specularF90(s_);
}

// Of a smooth surface, or of one microfacet met at this cosine.
shading::SpecularWeights Bsdf::microfacetWeights(float cosine) const {
  if (matched_) return {.reflection = glm::vec3(0.0f), .refraction = s_.transmission * s_.baseColor};
  shading::SpecularWeights w = shading::specularWeights(s_, cosine, refraction_.relativeIor.y, kExactFresnel);
  if (!refraction_.disperses()) return w;
  const shading::SpecularWeights red = shading::specularWeights(s_, cosine, refraction_.relativeIor.x, kExactFresnel);
  const shading::SpecularWeights blue = shading::specularWeights(s_, cosine, refraction_.relativeIor.z, kExactFresnel);
  w.reflection = {red.reflection.x, w.reflection.y, blue.reflection.z};
  w.refraction = {red.refraction.x, w.refraction.y, blue.refraction.z};
  return w;
}

std::optional<Ways> Bsdf::ways() const {
  if (isSpread()) return std::nullopt;
  Ways ways;
  if (straight_ > 0.0f)
    ways.add({straightOn_, glm::vec3(1.0f - s_.opacity), 0.0f, Lobe::straight, refraction_.channel});
  if (specular_ == 0.0f) return ways;
  const shading::SpecularWeights weights = microfacetWeights(NoV_);
  if (luminance(weights.reflection) > 0.0f) ways.add(reflect(s_.normal, NoV_, s_.opacity * weights.reflection, 1.0f));
  if (luminance(weights.refraction) > 0.0f) addRefracted(s_.opacity * weights.refraction, ways);
  return ways;
}

void Bsdf::addRefracted(const glm::vec3& weight, Ways& ways) const {
  const auto add = [&](const glm::vec3& ofChannel, int channel) {
    if (const auto ray = refract(s_.normal, NoV_, ofChannel, 1.0f, channel)) ways.add(*ray);
  };
  if (!splitsChannels()) return add(weight, refraction_.channel);
  for (int channel = 0; channel < 3; ++channel) {
    glm::vec3 ofChannel(0.0f);
    ofChannel[channel] = weight[channel];
    if (weight[channel] > 0.0f) add(ofChannel, channel);
  }
}

std::optional<ScatteredRay> Bsdf::sample(Sampler& sampler) const {
  if (straight_ == 1.0f)
    return ScatteredRay{straightOn_, glm::vec3(1.0f - s_.opacity), 0.0f, Lobe::straight, refraction_.channel};
  if (specular_ == 1.0f) return sampleSpecular(sampler);
  if (diffuse_ == 1.0f) return sampleDiffuse(sampler);
  if (straight_ + specular_ + diffuse_ == 0.0f) return std::nullopt;
  const float u = sampler.next();
  if (u < straight_)
    return ScatteredRay{straightOn_, glm::vec3((1.0f - s_.opacity) / straight_), 0.0f, Lobe::straight,
                        refraction_.channel};
  return u < straight_ + specular_ ? sampleSpecular(sampler) : sampleDiffuse(sampler);
}

std::optional<ScatteredRay> Bsdf::sampleDiffuse(Sampler& sampler) const {
  const glm::vec3 local = sampleCosine(sampler.next2());
  const float pdf = diffuse_ * local.z / shading::kPi;
  if (!(pdf > 0.0f)) return std::nullopt;
  return ScatteredRay{shading::toWorld(frame_, local), s_.opacity * diffuseReflectance_ / diffuse_, pdf, Lobe::diffuse,
                      refraction_.channel};
}

std::optional<ScatteredRay> Bsdf::sampleSpecular(Sampler& sampler) const {
  glm::vec3 h = s_.normal;
  float cosine = NoV_;
  if (rough_) {
    const glm::vec3 local =
        shading::sampleVisibleNormal(shading::toLocal(frame_, toViewer_), s_.alpha, sampler.next2());
    h = shading::toWorld(frame_, local);
    cosine = std::clamp(glm::dot(toViewer_, h), 0.0f, 1.0f);
  }
  const shading::SpecularWeights weights = microfacetWeights(cosine);
  const float reflection = luminance(weights.reflection), refraction = luminance(weights.refraction);
  if (!(reflection + refraction > 0.0f)) return std::nullopt;
  const float probability = share(reflection, refraction);
  const bool certain = reflection == 0.0f || refraction == 0.0f;
  const float outer = specular_ / s_.opacity;
  if (!(certain ? refraction == 0.0f : sampler.next() < probability)) {
    glm::vec3 weight = weights.refraction / (outer * (1.0f - probability));
    const int channel = splitsChannels() ? chooseChannel(weight, sampler.next()) : refraction_.channel;
    return refract(h, cosine, weight, specular_ * (1.0f - probability), channel);
  }
  const ScatteredRay ray = reflect(h, cosine, weights.reflection / (outer * probability), specular_ * probability);
  return ray.weight == glm::vec3(0.0f) ? std::nullopt : std::optional(ray);
}

// Weight of visible normals: F G2 / G1 (Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018,
// eq. 19). Directions under the horizon meet the surface again: single scattering loses them.
ScatteredRay Bsdf::reflect(const glm::vec3& h, float cosine, const glm::vec3& weight, float probability) const {
  ScatteredRay ray{shading::reflectedDirection(-toViewer_, h), weight, 0.0f, Lobe::specular, refraction_.channel};
  if (!rough_) return ray;
  const float NoL = glm::dot(s_.normal, ray.direction);
  ray.pdf = probability * visibleNormalPdf(h, cosine) / std::max(4.0f * cosine, 1e-12f);
  if (NoL <= 0.0f || !(ray.pdf > 0.0f)) {
    ray.weight = glm::vec3(0.0f);
    return ray;
  }
  ray.weight *= shading::G2_SmithGGXCorrelated(NoL, NoV_, s_.alpha) / shading::G1_SmithGGX(NoV_, s_.alpha);
  return ray;
}

// Whether the channels of refracted light part.
bool Bsdf::splitsChannels() const { return refraction_.disperses() && !matched_ && !shading::isThinWalled(s_); }

// Smooth: Snell's law. Rough: weight (1 - F) G1(L), masking and shadowing being independent on the two sides (Walter et
// al. 2007, eq. 23 and 41). Thin walls: the reflected direction mirrored through the wall. The channel is the one that
// the ray carries.
std::optional<ScatteredRay> Bsdf::refract(const glm::vec3& h, float cosine, const glm::vec3& weight, float probability,
                                          int channel) const {
  ScatteredRay ray{-toViewer_, weight, 0.0f, Lobe::specular, channel};
  if (shading::isThinWalled(s_)) {
    if (!rough_) return ray;
    ray = reflect(h, cosine, weight, probability);
    ray.direction = shading::reflectedDirection(ray.direction, s_.normal);
    return ray.weight == glm::vec3(0.0f) ? std::nullopt : std::optional(ray);
  }
  if (matched_) return ray;
  const float ior = refraction_.relativeIor[std::max(channel, 0)];
  ray.direction = shading::refractedDirection(-toViewer_, h, ior);
  if (ray.direction == glm::vec3(0.0f)) return std::nullopt;
  if (!rough_) return ray;
  const float NoL = glm::dot(s_.normal, ray.direction);
  if (NoL >= 0.0f) return std::nullopt;
  ray.weight *= shading::G1_SmithGGX(-NoL, s_.alpha);
  if (splitsChannels()) return ray;
  ray.pdf = probability * visibleNormalPdf(h, cosine) * refractionJacobian(cosine, glm::dot(ray.direction, h), ior);
  return ray.pdf > 0.0f ? std::optional(ray) : std::nullopt;
}

float Bsdf::visibleNormalPdf(const glm::vec3& h, float VoH) const {
  const float NoH = std::clamp(glm::dot(s_.normal, h), 0.0f, 1.0f);
  return shading::pdfVisibleNormal(NoV_, NoH, shading::crossSquared(s_.normal, h), VoH, s_.alpha);
}

LobeValues Bsdf::evaluate(const glm::vec3& toLight) const {
  LobeValues values;
  const float NoL = glm::dot(s_.normal, toLight);
  if (diffuse_ > 0.0f && NoL > 0.0f) {
    values.diffuse = s_.opacity * diffuseReflectance_ * NoL / shading::kPi;
    values.diffusePdf = diffuse_ * NoL / shading::kPi;
  }
  if (!rough_ || specular_ == 0.0f || NoL == 0.0f) return values;
  if (NoL > 0.0f) evaluateReflection(toLight, false, values);
  if (NoL < 0.0f && s_.kind == shading::kSurfaceGlass) {
    if (shading::isThinWalled(s_))
      evaluateReflection(shading::reflectedDirection(toLight, s_.normal), true, values);
    else if (!refraction_.disperses())
      evaluateRefraction(toLight, values);
  }
  return values;
}

// F D G2 / (4 NoL NoV) times NoL. What rough thin walls let through is reflected light, mirrored through the wall, with
// the weight of refraction in F's place.
void Bsdf::evaluateReflection(const glm::vec3& reflected, bool throughWall, LobeValues& values) const {
  const glm::vec3 h = shading::safeNormalize(toViewer_ + reflected);
  const float VoH = glm::dot(toViewer_, h), NoH = glm::dot(s_.normal, h), NoL = glm::dot(s_.normal, reflected);
  if (VoH <= 0.0f || NoH <= 0.0f) return;
  const shading::SpecularWeights weights = microfacetWeights(std::min(VoH, 1.0f));
  const float reflection = reflectionProbability(weights);
  const float D = shading::D_GGX(std::min(NoH, 1.0f), shading::crossSquared(s_.normal, h), s_.alpha);
  const float G2 = shading::G2_SmithGGXCorrelated(NoL, NoV_, s_.alpha);
  values.specular = s_.opacity * (throughWall ? weights.refraction : weights.reflection) * (D * G2 / (4.0f * NoV_));
  values.specularPdf = specular_ * (throughWall ? 1.0f - reflection : reflection) * visibleNormalPdf(h, VoH) /
                       std::max(4.0f * VoH, 1e-12f);
}

// Walter et al. 2007, eq. 21 times |NoL|, without its factor of n^2: the sample's weight times its density.
void Bsdf::evaluateRefraction(const glm::vec3& toLight, LobeValues& values) const {
  const float ior = refraction_.relativeIor.y;
  glm::vec3 h = shading::safeNormalize(toViewer_ + ior * toLight);
  if (glm::dot(h, s_.normal) < 0.0f) h = -h;
  const float VoH = glm::dot(toViewer_, h), LoH = glm::dot(toLight, h);
  if (VoH <= 0.0f || LoH >= 0.0f) return;
  const shading::SpecularWeights weights = microfacetWeights(std::min(VoH, 1.0f));
  const float normals = visibleNormalPdf(h, VoH) * refractionJacobian(VoH, LoH, ior);
  values.specular =
      s_.opacity * weights.refraction * (shading::G1_SmithGGX(-glm::dot(s_.normal, toLight), s_.alpha) * normals);
  values.specularPdf = specular_ * (1.0f - reflectionProbability(weights)) * normals;
}

}  // namespace pb
