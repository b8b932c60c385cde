#include "bench/attribution_objects.h"

#include <algorithm>
#include <map>

#include "bench/region_errors.h"

namespace pb {
namespace {

constexpr int kEnvironment = -1;

ObjectAttribution objectOf(const Snapshot& snapshot, int instance) {
  if (instance == kEnvironment) return {.object = "environment", .material = "", .pixels = 0, .steps = {}};
  const SnapshotInstance& shown = snapshot.instances[static_cast<std::size_t>(instance)];
  return {.object = snapshot.scene->instances[static_cast<std::size_t>(shown.source)].name,
          .material = snapshot.materialOf(shown).name,
          .pixels = 0,
          .steps = {}};
}

}  // namespace

Grid<int> instanceMap(const Grid<SampleId>& ids, int samplesPerAxis) {
  Grid<int> map(ids.width() / samplesPerAxis, ids.height() / samplesPerAxis);
  std::vector<int> samples;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      samples.clear();
      for (int j = 0; j < samplesPerAxis; ++j)
        for (int i = 0; i < samplesPerAxis; ++i)
          samples.push_back(static_cast<int>(ids(x * samplesPerAxis + i, y * samplesPerAxis + j).instance) - 1);
      map(x, y) = *std::ranges::max_element(samples, {}, [&](int id) { return std::ranges::count(samples, id); });
    }
  return map;
}

void addObjects(std::vector<ObjectAttribution>& objects, const std::string& step, const Snapshot& snapshot,
                const Grid<int>& instances, const ScoredImage& image) {
  std::map<int, RegionSums> sums;  // by instance
  double squares = 0.0;
  for (std::size_t i = 0; i < instances.size(); ++i)
    sums[instances[i]].add(image.reference[i], image.test[i], image.flipHdrMap[i]);
  for (const auto& [instance, sum] : sums) squares += sum.squares();
  if (objects.empty())
    for (const auto& [instance, sum] : sums) objects.push_back(objectOf(snapshot, instance));
  auto object = objects.begin();
  for (const auto& [instance, sum] : sums) {
    const RegionErrors errors = sum.errors(squares);
    object->pixels = errors.pixels;
    object->steps.push_back(
        {step,
         {{"mse", errors.mse}, {"relmse", errors.relmse}, {"bias", errors.bias}, {"flip_hdr", errors.flipHdr}},
         {}});
    ++object;
  }
}

}  // namespace pb
