#include "reference/light_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "reference/alias_table.h"
#include "reference/environment_density.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/luminance.h"

namespace pb {
namespace {

// The triangles of one instance that shine on others; those of unlit surfaces don't.
struct Emitter {
  int instance;
  glm::vec3 meanRadiance;
  bool bothSides;     // where rays meet the triangles from behind, they see emission, too
  bool isUniform;     // the same radiance at every point
  std::size_t first;  // of its triangles among all
};

struct Triangle {
  glm::vec3 corner, edge1, edge2;  // world, metres
  glm::vec3 normal;                // unit, on the side that emits
  float area;
};

Triangle makeTriangle(const SnapshotInstance& instance, std::size_t index) {
  const auto corner = [&](std::size_t k) {
    return glm::vec3(instance.worldFromObject *
                     glm::vec4(instance.mesh->positions[instance.mesh->indices[3 * index + k]], 1.0f));
  };
  const glm::vec3 a = corner(0);
  Triangle triangle{a, corner(1) - a, corner(2) - a, {}, 0.0f};
  const glm::vec3 cross = glm::cross(triangle.edge1, triangle.edge2);
  const float length = glm::length(cross);
  triangle.area = 0.5f * length;
  triangle.normal = (instance.mirrored ? -1.0f : 1.0f) * shading::safeNormalize(cross);
  return triangle;
}

std::vector<Emitter> findEmitters(const Snapshot& snapshot) {
  std::vector<Emitter> emitters;
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < snapshot.instances.size(); ++i) {
    const SnapshotInstance& instance = snapshot.instances[i];
    const Material& material = snapshot.materialOf(instance);
    const glm::vec3 radiance = meanEmission(snapshot, material);
    const float kind = material.constants.kind.x;
    if (kind == shading::kSurfaceUnlit || !(luminance(radiance) > 0.0f)) continue;
    emitters.push_back(
        {static_cast<int>(i), radiance, material.doubleSided || kind == shading::kSurfaceGlass,
         emissionTextureOf(snapshot, material) == nullptr && material.constants.alpha.x == shading::kAlphaOpaque,
         triangles});
    triangles += instance.mesh->triangleCount();
  }
  return emitters;
}

// Uniform on the triangle: Heitz, "A Low-Distortion Map Between Triangle and Square" (2019). Weights of the second and
// the third corner.
glm::vec2 triangleWeights(glm::vec2 u) {
  if (u.y > u.x) {
    u.x *= 0.5f;
    u.y -= u.x;
  } else {
    u.y *= 0.5f;
    u.x -= u.y;
  }
  return u;
}

// What the point of a triangle emits, times its opacity; textures at full resolution.
glm::vec3 emittedRadiance(const Snapshot& snapshot, const SnapshotInstance& instance, std::size_t triangle,
                          const glm::vec2& weights) {
  const Mesh& mesh = *instance.mesh;
  const auto mix = [&](const auto& attribute, const auto& otherwise) {
    if (attribute.empty()) return otherwise;
    const auto at = [&](std::size_t k) { return attribute[mesh.indices[3 * triangle + k]]; };
    return (1.0f - weights.x - weights.y) * at(0) + weights.x * at(1) + weights.y * at(2);
  };
  SurfaceAttributes a{};
  a.normal = {0.0f, 0.0f, 1.0f};
  a.uv0 = mix(mesh.uvs[0], glm::vec2(0.0f));
  a.uv1 = mix(mesh.uvs[1], glm::vec2(0.0f));
  a.color = mix(mesh.colors, glm::vec4(1.0f));
  a.cosine = 1.0f;
  const shading::Surface surface = readSurface(snapshot, snapshot.materialOf(instance), a);
  return surface.opacity * surface.emission;
}

// The environment's share of the samples. Its power is that through the bounding sphere (Pharr, Jakob and Humphreys,
// "Physically Based Rendering", 4th ed., section 12.6), flux being the integral of its radiance; the bounds keep
// samples for the lamps of a large landscape, which light what stands near them.
double environmentShare(double flux, double boundingRadius, double trianglePower) {
  if (flux <= 0.0) return 0.0;
  if (trianglePower <= 0.0) return 1.0;
  const double power = flux * static_cast<double>(shading::kPi) * boundingRadius * boundingRadius;
  return std::clamp(power / (power + trianglePower), 0.25, 0.75);
}

double boundingRadius(const Snapshot& snapshot) {
  Bounds bounds;
  for (const SnapshotInstance& instance : snapshot.instances) bounds.include(instance.worldBounds);
  return bounds.empty() ? 0.0 : 0.5 * static_cast<double>(glm::length(bounds.extent()));
}

}  // namespace

struct LightSampler::Impl {
  explicit Impl(const Snapshot& snapshot_)
      : snapshot(snapshot_), environment(snapshot_.environment()), emitters(findEmitters(snapshot_)) {
    for (std::size_t e = 0; e < emitters.size(); ++e) addTriangles(e);
    emitterOfInstance.assign(snapshot.instances.size(), -1);
    for (std::size_t e = 0; e < emitters.size(); ++e)
      emitterOfInstance[static_cast<std::size_t>(emitters[e].instance)] = static_cast<int>(e);
    buildTable();
  }

  void addTriangles(std::size_t emitter) {
    const SnapshotInstance& instance = snapshot.instances[static_cast<std::size_t>(emitters[emitter].instance)];
    for (std::size_t t = 0; t < instance.mesh->triangleCount(); ++t) {
      triangles.push_back(makeTriangle(instance, t));
      emitterOfTriangle.push_back(static_cast<std::uint32_t>(emitter));
    }
  }

  double powerOf(std::size_t triangle) const {
    const Emitter& emitter = emitters[emitterOfTriangle[triangle]];
    const double sides = emitter.bothSides ? 2.0 : 1.0;
    const double power = sides * static_cast<double>(shading::kPi) * static_cast<double>(triangles[triangle].area) *
                         static_cast<double>(luminance(emitter.meanRadiance));
    return std::isfinite(power) ? power : 0.0;
  }

  // The environment's cells, then the triangles.
  void buildTable() {
    std::vector<double> powers(triangles.size());
    double trianglePower = 0.0;
    for (std::size_t t = 0; t < powers.size(); ++t) trianglePower += powers[t] = powerOf(t);
    const double flux = environment.totalWeight();
    const double share = environmentShare(flux, boundingRadius(snapshot), trianglePower);
    if (share > 0.0) cellCount = environment.weights().size();
    if (cellCount + powers.size() > AliasTable::kMaxSize)
      throwInputError("scene '{}': {} triangles emit light, the reference takes at most {}", snapshot.scene->name,
                      powers.size(), AliasTable::kMaxSize - cellCount);

    std::vector<double> weights;
    weights.reserve(cellCount + powers.size());
    for (std::size_t cell = 0; cell < cellCount; ++cell) weights.push_back(share / flux * environment.weights()[cell]);
    for (const double power : powers)
      weights.push_back(trianglePower > 0.0 ? (1.0 - share) / trianglePower * power : 0.0);
    if (share > 0.0 || trianglePower > 0.0) table = AliasTable(weights);
    environment.forgetWeights();
  }

  // Density on the triangle's area turned into one on the sphere; 0 on the dark side.
  float trianglePdf(std::size_t index, const glm::vec3& direction, float distance) const {
    const Triangle& triangle = triangles[index];
    const float cosine = -glm::dot(triangle.normal, direction);
    if (cosine <= 0.0f && !emitters[emitterOfTriangle[index]].bothSides) return 0.0f;
    const float projected = triangle.area * std::abs(cosine);
    if (!(projected > 0.0f)) return 0.0f;
    return static_cast<float>(table.probability(cellCount + index)) * distance * distance / projected;
  }

  std::optional<Sample> sampleEnvironment(std::size_t cell, const glm::vec2& u) const {
    const EnvironmentDensity::Point point = environment.pointIn(cell, u);
    const glm::vec3 radiance = environmentRadiance(snapshot.environment(), point.direction);
    const float pdf = static_cast<float>(table.probability(cell)) * point.perSteradian;
    return Sample{point.direction, std::numeric_limits<float>::infinity(), radiance, pdf, -1};
  }

  std::optional<Sample> sampleTriangle(std::size_t index, const glm::vec3& position, const glm::vec2& u) const {
    const Triangle& triangle = triangles[index];
    const Emitter& emitter = emitters[emitterOfTriangle[index]];
    const glm::vec2 weights = triangleWeights(u);
    const glm::vec3 toLight = triangle.corner + weights.x * triangle.edge1 + weights.y * triangle.edge2 - position;
    const float distance = glm::length(toLight);
    if (!(distance > 0.0f)) return std::nullopt;
    const glm::vec3 direction = toLight / distance;
    const float pdf = trianglePdf(index, direction, distance);
    if (!(pdf > 0.0f) || !std::isfinite(pdf)) return std::nullopt;
    const SnapshotInstance& instance = snapshot.instances[static_cast<std::size_t>(emitter.instance)];
    const glm::vec3 radiance =
        emitter.isUniform ? emitter.meanRadiance : emittedRadiance(snapshot, instance, index - emitter.first, weights);
    return Sample{direction, distance, radiance, pdf, emitter.instance};
  }

  const Snapshot& snapshot;
  EnvironmentDensity environment;
  std::vector<Emitter> emitters;
  std::vector<int> emitterOfInstance;  // -1 for none
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> emitterOfTriangle;
  std::size_t cellCount = 0;  // of the environment in the table
  AliasTable table;
};

LightSampler::LightSampler(const Snapshot& snapshot) : impl_(std::make_unique<Impl>(snapshot)) {}
LightSampler::~LightSampler() = default;

std::optional<LightSampler::Sample> LightSampler::sample(const glm::vec3& position, const glm::vec2& uDirection,
                                                         float uChoice) const {
  if (empty()) return std::nullopt;
  const AliasTable::Choice choice = impl_->table.choose(uChoice, uDirection.x);
  const glm::vec2 u(choice.u, uDirection.y);
  if (choice.index < impl_->cellCount) return impl_->sampleEnvironment(choice.index, u);
  return impl_->sampleTriangle(choice.index - impl_->cellCount, position, u);
}

float LightSampler::pdfEnvironment(const glm::vec3& direction) const {
  if (impl_->cellCount == 0) return 0.0f;
  const EnvironmentDensity::Cell cell = impl_->environment.cellOf(direction);
  return static_cast<float>(impl_->table.probability(cell.index)) * cell.perSteradian;
}

float LightSampler::pdfTriangle(int instance, std::uint32_t triangle, const glm::vec3& position,
                                const glm::vec3& hitPoint) const {
  const int emitter = impl_->emitterOfInstance[static_cast<std::size_t>(instance)];
  if (emitter < 0) return 0.0f;
  const glm::vec3 toLight = hitPoint - position;
  const float distance = glm::length(toLight);
  if (!(distance > 0.0f)) return 0.0f;
  const std::size_t index = impl_->emitters[static_cast<std::size_t>(emitter)].first + triangle;
  return impl_->trianglePdf(index, toLight / distance, distance);
}

bool LightSampler::empty() const { return impl_->table.size() == 0; }

}  // namespace pb
