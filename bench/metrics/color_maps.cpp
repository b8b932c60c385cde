#include <algorithm>
#include <array>
#include <cmath>

#include "bench/metrics/metrics.h"

namespace pb {
namespace {

using ColorMap = std::array<glm::vec3, 256>;

const ColorMap kMagma{{
#include "bench/metrics/magma.inc"
}};

const ColorMap kViridis{{
#include "bench/metrics/viridis.inc"
}};

Image colored(const Plane& map, const ColorMap& colors) {
  Image image(map.width(), map.height());
  std::transform(map.begin(), map.end(), image.begin(), [&](float value) {
    const float index = std::floor(255.0f * std::clamp(value, 0.0f, 1.0f) + 0.5f);
    return colors[static_cast<std::size_t>(index)];
  });
  return image;
}

}  // namespace

Image magma(const Plane& map) { return colored(map, kMagma); }
Image viridis(const Plane& map) { return colored(map, kViridis); }

}  // namespace pb
