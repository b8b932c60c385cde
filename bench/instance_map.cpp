#include "bench/instance_map.h"

#include <algorithm>
#include <vector>

namespace pb {

Grid<int> mostFrequent(const Grid<SampleId>& ids, int samplesPerAxis,
                       const std::function<int(const SampleId&)>& value) {
  Grid<int> map(ids.width() / samplesPerAxis, ids.height() / samplesPerAxis);
  std::vector<int> samples;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      samples.clear();
      for (int j = 0; j < samplesPerAxis; ++j)
        for (int i = 0; i < samplesPerAxis; ++i)
          samples.push_back(value(ids(x * samplesPerAxis + i, y * samplesPerAxis + j)));
      map(x, y) = *std::ranges::max_element(samples, {}, [&](int v) { return std::ranges::count(samples, v); });
    }
  return map;
}

Grid<int> instanceMap(const Grid<SampleId>& ids, int samplesPerAxis) {
  return mostFrequent(ids, samplesPerAxis, [](const SampleId& id) { return static_cast<int>(id.instance) - 1; });
}

}  // namespace pb
