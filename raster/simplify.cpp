#include "raster/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace pb {

std::vector<std::uint32_t> simplifiedTriangles(const Mesh& mesh, float share) {
  constexpr float kLargestError = 0.1f;  // as a share of the mesh's extent
  const auto wanted = static_cast<std::size_t>(std::lround(share * static_cast<float>(mesh.triangleCount())));
  if (mesh.indices.empty() || wanted >= mesh.triangleCount()) return mesh.indices;
  std::vector<std::uint32_t> indices(mesh.indices.size());
  indices.resize(meshopt_simplify(indices.data(), mesh.indices.data(), mesh.indices.size(), &mesh.positions.front().x,
                                  mesh.positions.size(), sizeof(glm::vec3), 3 * std::max<std::size_t>(wanted, 1),
                                  kLargestError));
  return indices.empty() ? mesh.indices : indices;
}

}  // namespace pb
