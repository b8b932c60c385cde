#include "bench/material_errors.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>

namespace pb {
namespace {

constexpr int kEnvironment = -1;

int materialOf(const Snapshot& snapshot, const SampleId& id) {
  return id.instance == 0 ? kEnvironment : snapshot.instances[id.instance - 1].material;
}

// The most frequent value, the first of several.
int mode(const std::vector<int>& values) {
  const auto count = [&](int value) { return std::ranges::count(values, value); };
  return *std::ranges::max_element(values, {}, count);
}

// Sums over the pixels of one material; the order of pixels is fixed.
struct Sums {
  std::int64_t pixels = 0;
  double squares = 0, relativeSquares = 0, differences = 0, flip = 0;

  void add(const glm::dvec3& reference, const glm::dvec3& test, float flipValue) {
    const glm::dvec3 d = test - reference;
    const glm::dvec3 squared = d * d;
    const glm::dvec3 relative = squared / (reference * reference + 0.01);
    ++pixels;
    squares += squared.x + squared.y + squared.z;
    relativeSquares += relative.x + relative.y + relative.z;
    differences += d.x + d.y + d.z;
    flip += static_cast<double>(flipValue);
  }
};

}  // namespace

Grid<int> materialMap(const Snapshot& snapshot, const Grid<SampleId>& ids, int samplesPerAxis) {
  Grid<int> map(ids.width() / samplesPerAxis, ids.height() / samplesPerAxis);
  std::vector<int> samples;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      samples.clear();
      for (int j = 0; j < samplesPerAxis; ++j)
        for (int i = 0; i < samplesPerAxis; ++i)
          samples.push_back(materialOf(snapshot, ids(x * samplesPerAxis + i, y * samplesPerAxis + j)));
      map(x, y) = mode(samples);
    }
  return map;
}

std::vector<MaterialError> computeMaterialErrors(const Scene& scene, const Grid<int>& materials, const Image& reference,
                                                 const Image& test, const Plane& flipHdrMap) {
  assert(materials.size() == reference.size() && test.size() == reference.size());
  assert(flipHdrMap.size() == reference.size());
  std::vector<Sums> sums(scene.materials.size() + 1);  // the environment last
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const std::size_t entry =
        materials[i] == kEnvironment ? scene.materials.size() : static_cast<std::size_t>(materials[i]);
    sums[entry].add(glm::dvec3(reference[i]), glm::dvec3(test[i]), flipHdrMap[i]);
  }
  double total = 0;
  for (const Sums& s : sums) total += s.squares;
  std::vector<MaterialError> errors;
  for (std::size_t m = 0; m < sums.size(); ++m) {
    const Sums& s = sums[m];
    if (s.pixels == 0) continue;
    const double values = 3.0 * static_cast<double>(s.pixels);
    errors.push_back({.material = m < scene.materials.size() ? scene.materials[m].name : "environment",
                      .pixels = s.pixels,
                      .mse = s.squares / values,
                      .relmse = s.relativeSquares / values,
                      .bias = s.differences / values,
                      .flipHdr = s.flip / static_cast<double>(s.pixels),
                      .share = total > 0 ? s.squares / total : 0.0});
  }
  return errors;
}

}  // namespace pb
