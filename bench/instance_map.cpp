#include "bench/instance_map.h"

#include <algorithm>
#include <vector>

namespace pb {

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

}  // namespace pb
