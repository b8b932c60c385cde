// One path from the viewer through the scene, surface by surface. What it estimates and where it ends: integrator.h.
//
// A step has two halves. arrive() goes to the next surface and takes from it what needs no random numbers; depart()
// draws numbers and chooses the way on. So paths of one ray can share all that comes before the first number.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>

#include "reference/bsdf.h"
#include "reference/direct_light.h"
#include "reference/medium_stack.h"
#include "reference/renderer.h"
#include "reference/sampler.h"
#include "reference/surface_hit.h"

namespace pb {

struct PathResult {
  glm::vec3 radiance;
  std::int64_t rays;  // traced, shadow rays included
};

// The media before and behind a refractive surface, in the direction of the path; elsewhere twice the same.
struct Interface {
  Medium before;
  Medium behind;
};

// A surface that a path has come to. Not to be copied: the lobes refer to the surface.
struct Arrival {
  Arrival() = default;
  Arrival(const Arrival&) = delete;
  Arrival& operator=(const Arrival&) = delete;

  Hit hit{};
  shading::Surface surface{};
  Interface interface {};
  std::optional<Bsdf> bsdf;  // none where only what lies straight behind the surface counts
};

// Which of a path's rays it is.
enum class RayKind {
  primary,       // from the viewer, or straight on through what is only partly there
  specular,      // reflected or refracted, before any diffuse bounce
  firstDiffuse,  // of the first diffuse bounce
  later
};

// Of rays that nobody records.
struct NoRayLog {
  void add(const Ray&, RayKind) {}
};

// RayLog::add() is told of each ray that looks for the nearest surface; shadow rays are left out.
template <class RayLog>
class BasicPath {
 public:
  BasicPath(const TracedScene& scene, const Ray& primary, float conePerMetre, const ReferenceSettings& settings,
            RayLog log = {});

  // To the next surface, and light that is certain there; false at the end of the path.
  bool arrive(Arrival& arrival);

  // On from there; false at the end of the path.
  bool depart(const Arrival& arrival, Sampler& sampler);

  // On by steps of both kinds.
  void toTheEnd(Sampler& sampler);

  // All ways on from there, if neither they nor the light there need random numbers; none at the end of the path.
  std::optional<Ways> certainWays(const Arrival& arrival) const;

  // On by one of them; false if that leads nowhere.
  bool take(const Arrival& arrival, const ScatteredRay& way) { return goOn(arrival, way, false); }

  // Weight of what the path finds from here on.
  const glm::vec3& throughput() const { return throughput_; }

  // What it has found, and its rays, so far or since they were taken.
  const PathResult& result() const { return result_; }
  glm::vec3 takeRadiance() { return std::exchange(result_.radiance, glm::vec3(0.0f)); }
  std::int64_t takeRays() { return std::exchange(result_.rays, 0); }

 private:
  bool arriveInTheDark();
  std::optional<Hit> intersect();
  bool endsAt(const shading::Surface& surface) const;
  Vertex vertexAt(const Arrival& arrival) const;
  void add(const DirectLight& light) { result_.radiance += throughput_ * (light.diffuse + light.specular); }
  void addEnvironment();
  void addLight(const Vertex& vertex, const Arrival& arrival, Sampler* sampler);
  void addOwnLight(const Vertex& vertex, Sampler* sampler);
  glm::vec3 localLight(const Vertex& vertex, Sampler* sampler);
  bool lightNeedsNumbersAt(const shading::Surface& surface) const;
  bool goStraightOn(const Arrival& arrival);
  bool scatter(const Arrival& arrival, bool lightWasSampled, Sampler& sampler);
  bool goOn(const Arrival& arrival, const ScatteredRay& way, bool lightWasSampled);
  bool survives(Lobe lobe, const glm::vec3& lastWeight, Sampler& sampler);
  void absorb(const Medium& medium, float segmentMetres);
  Medium mediumOf(const Hit& hit) const;
  Interface interfaceAt(const Hit& hit, const shading::Surface& surface) const;
  InterfaceIor refractionAt(const Interface& interface) const;
  void crossInto(const Hit& hit);

  const TracedScene* scene_;
  const ReferenceSettings* settings_;
  float conePerMetre_;
  bool traced_;
  bool lightNeedsNumbers_;  // which point of which area light a shadow ray goes to
  [[no_unique_address]] RayLog log_;

  Ray ray_;
  RayKind kind_ = RayKind::primary;
  glm::vec3 d_;  // of the ray, unit
  glm::vec3 throughput_{1.0f};
  float lengthMetres_ = 0.0f;
  int specularHits_ = 0;
  int diffuseBounces_ = 0;
  bool onlyLightCounts_ = false;  // the limit of diffuse bounces is reached
  int channel_ = -1;              // the only one that is left after dispersion, -1 for all
  // Of the last direction that light samples might have found as well; 0 if they could not.
  float pdf_ = 0.0f;
  glm::vec3 lastPosition_{0.0f};  // from where they were looking
  PathResult result_{glm::vec3(0.0f), 0};
  MediumStack media_;
};

// Instantiated in path.cpp.
extern template class BasicPath<NoRayLog>;

}  // namespace pb
