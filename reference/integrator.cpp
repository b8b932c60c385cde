#include "reference/integrator.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "reference/bsdf.h"
#include "reference/direct_light.h"
#include "reference/light_sampler.h"
#include "reference/medium_stack.h"
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

// The media before and behind a refractive surface, in the direction of the path.
struct Interface {
  Medium before;
  Medium behind;
};

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

// Nothing goes on from here.
bool isOpaqueAndDiffuse(const shading::Surface& surface) {
  return surface.opacity == 1.0f && !shading::isSpecular(surface);
}

class Path {
 public:
  Path(const TracedScene& scene, const Ray& primary, float conePerMetre, const ReferenceSettings& settings,
       Sampler& sampler)
      : scene_(scene),
        settings_(settings),
        sampler_(sampler),
        conePerMetre_(conePerMetre),
        traced_(settings.diffuse == DiffuseTransport::traced),
        ray_(primary),
        d_(shading::safeNormalize(primary.direction)) {}

  PathResult trace() {
    while (goOn()) {
    }
    return result_;
  }

 private:
  // To the next surface and on from there; false at the end of the path.
  bool goOn() {
    const bool unoccluded = specularHits_ == settings_.depth;
    if (!unoccluded) ++result_.rays;
    const std::optional<Hit> hit = unoccluded ? std::nullopt : intersect();
    if (!hit) {
      addEnvironment();
      return false;
    }
    const float segment = hit->t * glm::length(ray_.direction);
    lengthMetres_ += segment;
    const shading::Surface surface = surfaceAt(scene_, *hit, d_, conePerMetre_ * lengthMetres_);
    if (isInterface(surface)) return goOnFrom(*hit, surface, segment, interfaceAt(*hit));
    const Medium& medium = media_.innermost();
    return goOnFrom(*hit, surface, segment, {medium, medium});
  }

  std::optional<Hit> intersect() const { return isPrimary_ ? scene_.intersectPrimary(ray_) : scene_.intersect(ray_); }

  bool goOnFrom(const Hit& hit, const shading::Surface& surface, float segment, const Interface& interface) {
    absorb(interface.before, segment);
    const Vertex vertex{.scene = scene_,
                        .hit = hit,
                        .surface = surface,
                        .toViewer = -d_,
                        .coneWidth = conePerMetre_ * lengthMetres_,
                        .absorptionBefore = interface.before.absorption(),
                        .absorptionBehind = interface.behind.absorption()};
    addLightOf(vertex);
    if (!traced_ && isOpaqueAndDiffuse(surface)) return false;
    if (onlyLightCounts_) return goStraightOn(hit, surface);
    const Bsdf bsdf(surface, -d_, refractionAt(interface), settings_.diffuse);
    // Under local transport the diffuse base has had its light, and only rough lobes are left.
    if (!scene_.snapshot.lights.empty() && bsdf.isSpread())
      add(punctualLight(vertex, bsdf, traced_ || scene_.snapshot.scene->castsShadows, result_.rays));
    const bool looksForLight = scene_.lights != nullptr && bsdf.isSpread();
    if (looksForLight) add(sampledLight(vertex, bsdf, specularHits_ + 1 == settings_.depth, sampler_, result_.rays));
    return scatter(hit, surface, bsdf, looksForLight);
  }

  void add(const DirectLight& light) { result_.radiance += throughput_ * (light.diffuse + light.specular); }

  void addEnvironment() {
    const glm::vec3 radiance = environmentRadiance(scene_.snapshot.environment(), d_);
    const float weight = pdf_ > 0.0f ? misWeight(pdf_, scene_.lights->pdfEnvironment(d_)) : 1.0f;
    result_.radiance += weight * throughput_ * radiance;
  }

  // What the surface sends to the viewer without further rays than shadow rays.
  void addLightOf(const Vertex& vertex) {
    const shading::Surface& s = vertex.surface;
    if (s.opacity == 0.0f) return;
    const bool foundEmission = pdf_ > 0.0f && s.kind != shading::kSurfaceUnlit && s.emission != glm::vec3(0.0f);
    glm::vec3 radiance =
        traced_ ? shading::localRadiance(s, glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)) : localLight(vertex);
    if (foundEmission) {
      const float lightPdf =
          scene_.lights->pdfTriangle(vertex.hit.instance, vertex.hit.triangle, lastPosition_, s.position);
      radiance -= (1.0f - misWeight(pdf_, lightPdf)) * s.emission;
    }
    result_.radiance += s.opacity * throughput_ * radiance;
  }

  glm::vec3 localLight(const Vertex& vertex) {
    if (scene_.snapshot.scene->castsShadows) return shadowedLocalRadiance(vertex, sampler_, result_.rays);
    return localRadiance(scene_.snapshot, vertex.surface, vertex.toViewer);
  }

  // What lies behind a surface that is only partly there.
  bool goStraightOn(const Hit& hit, const shading::Surface& surface) {
    throughput_ *= 1.0f - surface.opacity;
    if (surface.opacity == 1.0f) return false;
    ray_ = {offsetOrigin(scene_, hit, surface.position, d_), d_};
    return true;
  }

  bool scatter(const Hit& hit, const shading::Surface& surface, const Bsdf& bsdf, bool lightWasSampled) {
    const std::optional<ScatteredRay> next = bsdf.sample(sampler_);
    if (!next) return false;
    throughput_ *= next->weight;
    if (throughput_ == glm::vec3(0.0f)) return false;
    channel_ = next->channel;
    if (next->lobe != Lobe::straight) {
      pdf_ = lightWasSampled ? next->pdf : 0.0f;
      lastPosition_ = surface.position;
      isPrimary_ = false;
      if (next->lobe == Lobe::specular) ++specularHits_;
      if (next->lobe == Lobe::diffuse) onlyLightCounts_ = diffuseBounces_++ == settings_.diffuseDepth;
      if (!survives(next->lobe, next->weight)) return false;
    }
    d_ = shading::safeNormalize(next->direction);
    ray_ = {offsetOrigin(scene_, hit, surface.position, d_), d_};
    if (isInterface(surface)) crossInto(hit);
    return true;
  }

  // Russian roulette: false ends the path, else the throughput makes up for the paths that ended. Surviving with the
  // last hit's own weight keeps the throughput of survivors what it was when roulette began: a small part of the pixel,
  // so that the few survivors don't stand out.
  bool survives(Lobe lobe, const glm::vec3& lastWeight) {
    const bool spared = lobe == Lobe::specular ? settings_.depth || specularHits_ <= kRouletteFreeHits
                                               : diffuseBounces_ <= kRouletteFreeBounces;
    if (spared) return true;
    const float probability = std::min(std::max({lastWeight.x, lastWeight.y, lastWeight.z}), kMaxSurvival);
    if (sampler_.next() >= probability) return false;
    throughput_ /= probability;
    return true;
  }

  void absorb(const Medium& medium, float segmentMetres) {
    if (medium.material == nullptr || medium.absorption() == glm::vec3(0.0f)) return;
    throughput_ *= shading::transmittance(medium.absorption(), segmentMetres);
  }

  Medium mediumOf(const Hit& hit) const {
    const Scene& content = *scene_.snapshot.scene;
    return {.instance = hit.instance,
            .node = content.instances[static_cast<std::size_t>(hit.instance)].node,
            .material = &scene_.materialOf(hit)};
  }

  // Leaving what was never entered, the path has been inside all along: the viewer is, or the mesh is open.
  Interface interfaceAt(const Hit& hit) const {
    const Medium medium = mediumOf(hit);
    MediumStack behind = media_;
    if (hit.entering) {
      behind.enter(medium);
      return {media_.innermost(), behind.innermost()};
    }
    behind.leave(medium);
    return {media_.contains(medium) ? media_.innermost() : medium, behind.innermost()};
  }

  InterfaceIor refractionAt(const Interface& interface) const {
    return {iorOf(interface.behind, channel_) / iorOf(interface.before, channel_), channel_};
  }

  // The side of the triangle says where the path is, whatever the lobe.
  void crossInto(const Hit& hit) {
    const bool behind = glm::dot(d_, hit.geometricNormal) < 0.0f;
    if (behind == hit.entering)
      media_.enter(mediumOf(hit));
    else
      media_.leave(mediumOf(hit));
  }

  const TracedScene& scene_;
  const ReferenceSettings& settings_;
  Sampler& sampler_;
  const float conePerMetre_;
  const bool traced_;

  Ray ray_;
  glm::vec3 d_;  // of the ray, unit
  bool isPrimary_ = true;
  glm::vec3 throughput_{1.0f};
  float lengthMetres_ = 0.0f;
  int specularHits_ = 0;
  int diffuseBounces_ = 0;
  bool onlyLightCounts_ = false;  // the limit of diffuse bounces is reached
  int channel_ = -1;              // the only one that is left after dispersion, -1 for all
  MediumStack media_;
  // Of the last direction that light samples might have found as well; 0 if they could not.
  float pdf_ = 0.0f;
  glm::vec3 lastPosition_{0.0f};  // from where they were looking
  PathResult result_{glm::vec3(0.0f), 0};
};

}  // namespace

PathResult tracePath(const TracedScene& scene, const Ray& primary, float conePerMetre,
                     const ReferenceSettings& settings, Sampler& sampler) {
  return Path(scene, primary, conePerMetre, settings, sampler).trace();
}

}  // namespace pb
