#include "bench/noise.h"

#include <cassert>
#include <glm/geometric.hpp>

namespace pb {

double computeUnbiasedMse(const Image& image, const Image& a, const Image& b) {
  assert(image.size() == a.size() && image.size() == b.size() && !image.empty());
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i)
    sum += glm::dot(glm::dvec3(image[i]) - glm::dvec3(a[i]), glm::dvec3(image[i]) - glm::dvec3(b[i]));
  return sum / (3.0 * static_cast<double>(image.size()));
}

}  // namespace pb
