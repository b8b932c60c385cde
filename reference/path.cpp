#include "reference/path.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "reference/light_sampler.h"
#include "reference/ray_log.h"
#include "scenes/environment.h"

namespace pb {
namespace {

// Hits that a path may make before Russian roulette: enough for all chains that are visible in ordinary scenes, which
// therefore stay free of noise.
constexpr int kRouletteFreeHits = 16;
// What five bounces leave of light is seldom worth a ray: 3 % at an albedo of 1/2.
constexpr int kRouletteFreeBounces = 4;
// Below 1, or paths between two perfect mirrors would never end.
constexpr float kMaxSurvival = 0.95f;

glm::vec3 iorOf(const Medium& medium, int channel) {
  if (medium.dispersion() == 0.0f) return glm::vec3(medium.ior());
  const auto ior = [&](int c) {
    return shading::channelIor(medium.ior(), medium.dispersion(), channel < 0 ? c : channel);
  };
  return {ior(0), ior(1), ior(2)};
}

// Refracts, and has an inside.
bool isInterface(const shading::Surface& surface) {
  return surface.kind == shading::kSurfaceGlass && !shading::isThinWalled(surface);
}

bool needsNumbersForLight(const Snapshot& snapshot, DiffuseTransport diffuse) {
  return diffuse == DiffuseTransport::local && snapshot.scene->castsShadows && !snapshot.areaLights.empty();
}

RayKind kindAfter(Lobe lobe, int diffuseBounces) {
  if (diffuseBounces == 0) return RayKind::specular;
  return lobe == Lobe::diffuse && diffuseBounces == 1 ? RayKind::firstDiffuse : RayKind::later;
}

}  // namespace

template <class RayLog>
BasicPath<RayLog>::BasicPath(const TracedScene& scene, const Ray& primary, float conePerMetre,
                             const ReferenceSettings& settings, RayLog log)
    : scene_(&scene),
      settings_(&settings),
      conePerMetre_(conePerMetre),
      traced_(settings.diffuse == DiffuseTransport::traced),
      lightNeedsNumbers_(needsNumbersForLight(scene.snapshot, settings.diffuse)),
      log_(log),
      ray_(primary),
      d_(shading::safeNormalize(primary.direction)) {}

template <class RayLog>
bool BasicPath<RayLog>::arrive(Arrival& arrival) {
  const bool unoccluded = specularHits_ == settings_->depth;
  if (!unoccluded && onlyLightCounts_ && scene_->isAllDark) return arriveInTheDark();
  const std::optional<Hit> hit = unoccluded ? std::nullopt : intersect();
  if (!hit) {
    addEnvironment();
    return false;
  }
  if (onlyLightCounts_ && scene_->isDark(hit->instance)) return false;
  const float segment = hit->t * glm::length(ray_.direction);
  lengthMetres_ += segment;
  arrival.hit = *hit;
  arrival.surface = surfaceAt(*scene_, *hit, d_, conePerMetre_ * lengthMetres_);
  arrival.interface = interfaceAt(*hit, arrival.surface);
  absorb(arrival.interface.before, segment);
  arrival.bsdf.reset();
  if (!onlyLightCounts_ && !endsAt(arrival.surface))
    arrival.bsdf.emplace(arrival.surface, -d_, refractionAt(arrival.interface), settings_->diffuse);
  if (!lightNeedsNumbersAt(arrival.surface)) addLight(vertexAt(arrival), arrival, nullptr);
  return true;
}

// Where nothing but the environment could count any more, it doesn't matter what hides it.
template <class RayLog>
bool BasicPath<RayLog>::arriveInTheDark() {
  ++result_.rays;
  if (scene_->occlusion(ray_, std::numeric_limits<float>::infinity()) == Occlusion::none) addEnvironment();
  return false;
}

template <class RayLog>
bool BasicPath<RayLog>::depart(const Arrival& arrival, Sampler& sampler) {
  const Vertex vertex = vertexAt(arrival);
  if (lightNeedsNumbersAt(arrival.surface)) addLight(vertex, arrival, &sampler);
  if (endsAt(arrival.surface)) return false;
  if (!arrival.bsdf) return goStraightOn(arrival);
  const bool looksForLight = scene_->lights != nullptr && arrival.bsdf->isSpread();
  if (looksForLight)
    add(sampledLight(vertex, *arrival.bsdf, specularHits_ + 1 == settings_->depth, sampler, result_.rays));
  return scatter(arrival, looksForLight, sampler);
}

template <class RayLog>
void BasicPath<RayLog>::toTheEnd(Sampler& sampler) {
  Arrival arrival;
  while (arrive(arrival) && depart(arrival, sampler)) {
  }
}

template <class RayLog>
std::optional<Ways> BasicPath<RayLog>::certainWays(const Arrival& arrival) const {
  if (lightNeedsNumbersAt(arrival.surface)) return std::nullopt;
  if (endsAt(arrival.surface)) return Ways{};
  const bool mayEndByChance = !settings_->depth && specularHits_ >= kRouletteFreeHits;
  if (!arrival.bsdf || mayEndByChance) return std::nullopt;
  return arrival.bsdf->ways();
}

template <class RayLog>
std::optional<Hit> BasicPath<RayLog>::intersect() {
  ++result_.rays;
  log_.add(ray_, kind_);
  return kind_ == RayKind::primary ? scene_->intersectPrimary(ray_) : scene_->intersect(ray_);
}

// Nothing goes on from there.
template <class RayLog>
bool BasicPath<RayLog>::endsAt(const shading::Surface& surface) const {
  return !traced_ && surface.opacity == 1.0f && !shading::isSpecular(surface);
}

template <class RayLog>
Vertex BasicPath<RayLog>::vertexAt(const Arrival& arrival) const {
  return {.scene = *scene_,
          .hit = arrival.hit,
          .surface = arrival.surface,
          .toViewer = -d_,
          .coneWidth = conePerMetre_ * lengthMetres_,
          .absorptionBefore = arrival.interface.before.absorption(),
          .absorptionBehind = arrival.interface.behind.absorption()};
}

template <class RayLog>
void BasicPath<RayLog>::addEnvironment() {
  const glm::vec3 radiance = environmentRadiance(scene_->snapshot.environment(), d_);
  const float weight = pdf_ > 0.0f ? misWeight(pdf_, scene_->lights->pdfEnvironment(d_)) : 1.0f;
  result_.radiance += weight * throughput_ * radiance;
}

// All that isn't found by chance or by sampling of lights.
template <class RayLog>
void BasicPath<RayLog>::addLight(const Vertex& vertex, const Arrival& arrival, Sampler* sampler) {
  addOwnLight(vertex, sampler);
  // Under local transport the diffuse base has had its light, and only rough lobes are left.
  if (!arrival.bsdf || scene_->snapshot.lights.empty() || !arrival.bsdf->isSpread()) return;
  add(punctualLight(vertex, *arrival.bsdf, traced_ || scene_->snapshot.scene->castsShadows, result_.rays));
}

// What the surface sends to the viewer without further rays than shadow rays.
template <class RayLog>
void BasicPath<RayLog>::addOwnLight(const Vertex& vertex, Sampler* sampler) {
  const shading::Surface& s = vertex.surface;
  if (s.opacity == 0.0f) return;
  const bool foundEmission = pdf_ > 0.0f && s.kind != shading::kSurfaceUnlit && s.emission != glm::vec3(0.0f);
  glm::vec3 radiance = traced_ ? shading::localRadiance(s, glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f))
                               : localLight(vertex, sampler);
  if (foundEmission) {
    const float lightPdf =
        scene_->lights->pdfTriangle(vertex.hit.instance, vertex.hit.triangle, lastPosition_, s.position);
    radiance -= (1.0f - misWeight(pdf_, lightPdf)) * s.emission;
  }
  result_.radiance += s.opacity * throughput_ * radiance;
}

template <class RayLog>
glm::vec3 BasicPath<RayLog>::localLight(const Vertex& vertex, Sampler* sampler) {
  if (scene_->snapshot.scene->castsShadows) return shadowedLocalRadiance(vertex, sampler, result_.rays);
  return localRadiance(scene_->snapshot, vertex.surface, vertex.toViewer);
}

template <class RayLog>
bool BasicPath<RayLog>::lightNeedsNumbersAt(const shading::Surface& surface) const {
  return lightNeedsNumbers_ && surface.kind != shading::kSurfaceUnlit &&
         shading::diffuseAlbedo(surface) != glm::vec3(0.0f);
}

// What lies behind a surface that is only partly there.
template <class RayLog>
bool BasicPath<RayLog>::goStraightOn(const Arrival& arrival) {
  throughput_ *= 1.0f - arrival.surface.opacity;
  if (arrival.surface.opacity == 1.0f) return false;
  ray_ = {offsetOrigin(*scene_, arrival.hit, arrival.surface.position, d_), d_};
  return true;
}

template <class RayLog>
bool BasicPath<RayLog>::scatter(const Arrival& arrival, bool lightWasSampled, Sampler& sampler) {
  const std::optional<ScatteredRay> next = arrival.bsdf->sample(sampler);
  if (!next || !goOn(arrival, *next, lightWasSampled)) return false;
  return next->lobe == Lobe::straight || survives(next->lobe, next->weight, sampler);
}

template <class RayLog>
bool BasicPath<RayLog>::goOn(const Arrival& arrival, const ScatteredRay& way, bool lightWasSampled) {
  throughput_ *= way.weight;
  if (throughput_ == glm::vec3(0.0f)) return false;
  channel_ = way.channel;
  if (way.lobe != Lobe::straight) {
    pdf_ = lightWasSampled ? way.pdf : 0.0f;
    lastPosition_ = arrival.surface.position;
    if (way.lobe == Lobe::specular) ++specularHits_;
    if (way.lobe == Lobe::diffuse) onlyLightCounts_ = diffuseBounces_++ == settings_->diffuseDepth;
    kind_ = kindAfter(way.lobe, diffuseBounces_);
  }
  d_ = shading::safeNormalize(way.direction);
  ray_ = {offsetOrigin(*scene_, arrival.hit, arrival.surface.position, d_), d_};
  if (isInterface(arrival.surface)) crossInto(arrival.hit);
  return true;
}

// Russian roulette: false ends the path, else the throughput makes up for the paths that ended. Surviving with the
// last hit's own weight keeps the throughput of survivors what it was when roulette began: a small part of the pixel,
// so that the few survivors don't stand out.
template <class RayLog>
bool BasicPath<RayLog>::survives(Lobe lobe, const glm::vec3& lastWeight, Sampler& sampler) {
  const bool spared = lobe == Lobe::specular ? settings_->depth || specularHits_ <= kRouletteFreeHits
                                             : diffuseBounces_ <= kRouletteFreeBounces;
  if (spared) return true;
  const float probability = std::min(std::max({lastWeight.x, lastWeight.y, lastWeight.z}), kMaxSurvival);
  if (sampler.next() >= probability) return false;
  throughput_ /= probability;
  return true;
}

template <class RayLog>
void BasicPath<RayLog>::absorb(const Medium& medium, float segmentMetres) {
  if (medium.material == nullptr || medium.absorption() == glm::vec3(0.0f)) return;
  throughput_ *= shading::transmittance(medium.absorption(), segmentMetres);
}

template <class RayLog>
Medium BasicPath<RayLog>::mediumOf(const Hit& hit) const {
  const Scene& content = *scene_->snapshot.scene;
  return {.instance = hit.instance,
          .node = content.instances[static_cast<std::size_t>(hit.instance)].node,
          .material = &scene_->materialOf(hit)};
}

// Leaving what was never entered, the path has been inside all along: the viewer is, or the mesh is open.
template <class RayLog>
Interface BasicPath<RayLog>::interfaceAt(const Hit& hit, const shading::Surface& surface) const {
  if (!isInterface(surface)) return {media_.innermost(), media_.innermost()};
  const Medium medium = mediumOf(hit);
  MediumStack behind = media_;
  if (hit.entering) {
    behind.enter(medium);
    return {media_.innermost(), behind.innermost()};
  }
  behind.leave(medium);
  return {media_.contains(medium) ? media_.innermost() : medium, behind.innermost()};
}

template <class RayLog>
InterfaceIor BasicPath<RayLog>::refractionAt(const Interface& interface) const {
  if (interface.behind.material == interface.before.material) return {glm::vec3(1.0f), channel_};
  return {iorOf(interface.behind, channel_) / iorOf(interface.before, channel_), channel_};
}

// The side of the triangle says where the path is, whatever the lobe.
template <class RayLog>
void BasicPath<RayLog>::crossInto(const Hit& hit) {
  const bool behind = glm::dot(d_, hit.geometricNormal) < 0.0f;
  if (behind == hit.entering)
    media_.enter(mediumOf(hit));
  else
    media_.leave(mediumOf(hit));
}

template class BasicPath<NoRayLog>;
template class BasicPath<RayLog>;

}  // namespace pb
