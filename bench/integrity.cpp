#include "bench/integrity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <numeric>

#include "raster/lookup.h"
#include "raster/planar.h"
#include "raster/prefilter.h"
#include "raster/probe_views.h"
#include "raster/reflection.h"
#include "reference/renderer.h"

namespace pb {
namespace {

constexpr int kExpectedResolution = 16;

glm::dvec3 displayed(const glm::vec3& radiance) {
  const glm::dvec3 r(glm::max(radiance, glm::vec3(0.0f)));
  return r / (1.0 + r);
}

double stepBetween(const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 d = glm::abs(displayed(a) - displayed(b));
  return d.x + d.y + d.z;
}

// Texel `along` of the row that is `inward` texels from edge `edge` of a face: 0 top, 1 bottom, 2 left, 3 right.
glm::ivec2 texelAtEdge(int edge, int along, int inward, int n) {
  const int across = edge % 2 == 0 ? inward : n - 1 - inward;
  return edge < 2 ? glm::ivec2(along, across) : glm::ivec2(across, along);
}

const glm::vec3& texelOf(const CubeFaces& faces, const glm::ivec3& texel) {
  return faces[static_cast<std::size_t>(texel.z)](texel.x, texel.y);
}

// Directions of the texel coordinates, transcribed from OpenGL 4.5 core, table 8.19, and kept apart from
// scenes/shading/cubemap.glsl, by which captures are made: for face +X, sc = -rz and tc = -ry, and so on.
glm::vec3 specifiedDirection(int face, float sc, float tc) {
  const std::array<glm::vec3, 6> directions = {
      {{1.0f, -tc, -sc}, {-1.0f, -tc, sc}, {sc, 1.0f, tc}, {sc, -1.0f, -tc}, {sc, -tc, 1.0f}, {-sc, -tc, -1.0f}}};
  return directions[static_cast<std::size_t>(face)];
}

shading::View specifiedView(const glm::vec3& position, int face, float zNear) {
  const glm::vec3 forward = specifiedDirection(face, 0.0f, 0.0f);
  return {.origin = glm::vec4(position, zNear),
          .forward = glm::vec4(forward, 0.0f),
          .right = glm::vec4(specifiedDirection(face, 1.0f, 0.0f) - forward, 0.0f),
          .down = glm::vec4(specifiedDirection(face, 0.0f, 1.0f) - forward, 0.0f)};
}

// Means of squares of texels.
Image reduced(const Image& face, int resolution) {
  const int n = face.width() / resolution;
  assert(n * resolution == face.width());
  Image small(resolution, resolution);
  for (int y = 0; y < face.height(); ++y)
    for (int x = 0; x < face.width(); ++x) small(x / n, y / n) += face(x, y) / static_cast<float>(n * n);
  return small;
}

// One of the eight ways to lay a square on itself, 0: as it is.
glm::ivec2 turned(int x, int y, int n, int way) {
  if ((way & 4) != 0) std::swap(x, y);
  if ((way & 2) != 0) y = n - 1 - y;
  if ((way & 1) != 0) x = n - 1 - x;
  return {x, y};
}

double difference(const Image& a, const Image& b, int way) {
  double sum = 0.0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const glm::ivec2 t = turned(x, y, a.width(), way);
      const glm::dvec3 d = displayed(a(x, y)) - displayed(b(t.x, t.y));
      sum += glm::dot(d, d);
    }
  return sum / static_cast<double>(a.size());
}

// Whether the face is clearly another one of those expected, or its own laid otherwise.
bool isMisplaced(const Image& face, const CubeFaces& expected, int own) {
  const double here = difference(face, expected[static_cast<std::size_t>(own)], 0);
  double elsewhere = std::numeric_limits<double>::infinity();
  for (int other = 0; other < 6; ++other)
    for (int way = 0; way < 8; ++way)
      if (other != own || way != 0)
        elsewhere = std::min(elsewhere, difference(face, expected[static_cast<std::size_t>(other)], way));
  // What belongs there leaves of the squared difference next to nothing; what other faces of a room have in common with
  // it, a quarter at most. Better by more than the noise of either, 1e-3 of white.
  return elsewhere < 0.2 * here && here - elsewhere > 1e-6;
}

std::string keyOf(const ProbeViews& views) {
  std::string key;
  for (const ProbeView& probe : views.probes)
    key += fmt::format("{} {} {} {} [{}] ", probe.position.x, probe.position.y, probe.position.z, probe.zNear,
                       fmt::join(probe.hidden, ","));
  return key;
}

CubeFaces traceExpected(const ReferenceScene& scene, const ProbeView& probe) {
  ReferenceSettings settings;
  settings.samplesPerAxis = 2;
  settings.spp = 2;
  settings.depth = 3;  // about what mirrors show in the maps
  settings.hiddenFromPrimary = probe.hidden;
  CubeFaces faces;
  for (int face = 0; face < 6; ++face)
    faces[static_cast<std::size_t>(face)] = scene
                                                .render(specifiedView(probe.position, face, probe.zNear),
                                                        kExpectedResolution, kExpectedResolution, settings)
                                                .mean();
  return faces;
}

int levelsOf(const Technique& technique, const Snapshot& laidOut, std::size_t probe, int resolution) {
  const bool areShown = technique.mips || probesWithLevels(technique, laidOut)[probe];
  if (!areShown || technique.storage != Storage::cube) return 1;
  return 1 + filteredLevels(levelFilter(technique, laidOut), resolution);
}

// By level.
struct LevelSums {
  double edgeStep = 0.0;  // largest
  double radiance = 0.0;
  int probes = 0;
};

}  // namespace

double edgeStepRatio(const CubeFaces& faces) {
  const int n = faces.front().width();
  assert(n >= 2);
  double across = 0.0, inside = 0.0;
  for (int face = 0; face < 6; ++face)
    for (int edge = 0; edge < 4; ++edge)
      for (int i = 0; i < n; ++i) {
        const glm::ivec2 outer = texelAtEdge(edge, i, 0, n), inner = texelAtEdge(edge, i, 1, n);
        const glm::ivec2 beyond = 2 * outer - inner;
        const glm::vec3& texel = texelOf(faces, glm::ivec3(outer, face));
        across += stepBetween(texel, texelOf(faces, shading::cubeWrapTexel(beyond, face, n)));
        inside += stepBetween(texel, texelOf(faces, glm::ivec3(inner, face)));
      }
  if (across == 0.0) return inside == 0.0 ? 1.0 : 0.0;
  return across / std::max(inside, 1e-6 * across);
}

Grid<double> texelSolidAngles(int resolution) {
  Grid<double> angles(resolution, resolution);
  for (int y = 0; y < resolution; ++y)
    for (int x = 0; x < resolution; ++x)
      angles(x, y) = static_cast<double>(shading::cubeTexelSolidAngle(glm::ivec2(x, y), resolution));
  return angles;
}

double solidAngleError(const Grid<double>& solidAngles) {
  const double sum = std::accumulate(solidAngles.begin(), solidAngles.end(), 0.0);
  return std::abs(6.0 * sum / (4.0 * std::numbers::pi) - 1.0);
}

double meanRadiance(const CubeFaces& faces, const Grid<double>& solidAngles) {
  double sum = 0.0;
  for (const Image& face : faces)
    for (std::size_t i = 0; i < face.size(); ++i) {
      const glm::dvec3 radiance(face[i]);
      sum += solidAngles[i] * (radiance.x + radiance.y + radiance.z) / 3.0;
    }
  return sum / (4.0 * std::numbers::pi);
}

int misplacedFaces(const CubeFaces& faces, const CubeFaces& expected) {
  const int resolution = std::min(faces.front().width(), expected.front().width());
  CubeFaces known;
  for (std::size_t face = 0; face < 6; ++face) known[face] = reduced(expected[face], resolution);
  int misplaced = 0;
  for (int face = 0; face < 6; ++face)
    misplaced += isMisplaced(reduced(faces[static_cast<std::size_t>(face)], resolution), known, face) ? 1 : 0;
  return misplaced;
}

MetricValues IntegrityMeter::measure(RasterSequence& sequence, const Technique& technique,
                                     const std::shared_ptr<const Snapshot>& snapshot, int heightPx) {
  if (technique.probes != ProbeUse::dynamic || viewsOfProbe(technique) != 6) return {};
  if (snapshot_.lock() != snapshot) expected_.clear();
  snapshot_ = snapshot;
  const ProbeViews views = probeViews(technique, snapshot, heightPx);
  if (views.probes.empty() || !looksUpMaps(technique, *views.snapshot)) return {};
  const std::vector<CubeFaces>& expected = expectedFaces(views);
  int misplaced = 0;
  double angleError = 0.0;
  std::vector<LevelSums> levels;
  for (std::size_t probe = 0; probe < views.probes.size(); ++probe) {
    const int resolution = views.probes[probe].resolutionPx;
    const int count = levelsOf(technique, *views.snapshot, probe, resolution);
    levels.resize(std::max(levels.size(), static_cast<std::size_t>(count)));
    for (int level = 0; level < count && resolution >> level >= 2; ++level) {
      const CubeFaces faces = sequence.readProbe(static_cast<int>(probe), level);
      if (level == 0) misplaced += misplacedFaces(faces, expected[probe]);
      LevelSums& sums = levels[static_cast<std::size_t>(level)];
      sums.edgeStep = std::max(sums.edgeStep, edgeStepRatio(faces));
      const Grid<double>& angles = solidAngles(faces.front().width());
      sums.radiance += meanRadiance(faces, angles);
      ++sums.probes;
      angleError = std::max(angleError, solidAngleError(angles));
    }
  }
  MetricValues values = {{"probes", static_cast<double>(views.probes.size())},
                         {"misplaced_faces", static_cast<double>(misplaced)},
                         {"solid_angle_error", angleError}};
  for (std::size_t level = 0; level < levels.size() && levels[level].probes > 0; ++level) {
    values.emplace_back(fmt::format("edge_step_mip{}", level), levels[level].edgeStep);
    values.emplace_back(fmt::format("radiance_mip{}", level), levels[level].radiance / levels[level].probes);
  }
  return values;
}

const Grid<double>& IntegrityMeter::solidAngles(int resolution) {
  const auto [found, isNew] = solidAngles_.try_emplace(resolution);
  if (isNew) found->second = texelSolidAngles(resolution);
  return found->second;
}

const std::vector<CubeFaces>& IntegrityMeter::expectedFaces(const ProbeViews& views) {
  const auto [found, isNew] = expected_.try_emplace(keyOf(views));
  if (!isNew) return found->second;
  const ReferenceScene scene(views.snapshot);
  for (const ProbeView& probe : views.probes) found->second.push_back(traceExpected(scene, probe));
  return found->second;
}

}  // namespace pb
