// How much light the environment sends from where: cells of the six cube faces, weighted by radiance times solid angle.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "scenes/scene.h"

namespace pb {

// Every direction from which light comes lies in a cell of positive weight. Cube maps are read with a bilinear filter:
// a cell's weight is the mean of the filtered radiance, so that a dark texel beside a bright one has its share. A
// gradient is averaged over 4 x 4 points, and 5 % of the weight is spread evenly, so that a glow narrower than a cell
// can't be missed.
class EnvironmentDensity {
 public:
  explicit EnvironmentDensity(const Environment& environment);

  // Luminance times solid angle, by cell; empty after forgetWeights().
  const std::vector<double>& weights() const { return weights_; }
  double totalWeight() const { return totalWeight_; }
  void forgetWeights() { weights_ = {}; }

  struct Point {
    glm::vec3 direction;  // unit
    float perSteradian;   // density of points in the cell there
  };
  // For uniform numbers in [0, 1).
  Point pointIn(std::size_t cell, const glm::vec2& u) const;

  struct Cell {
    std::size_t index;
    float perSteradian;  // density of pointIn() in this direction
  };
  Cell cellOf(const glm::vec3& direction) const;

 private:
  // Where the cells of a row begin and end, in [-1, 1].
  float edge(int i) const;
  float perSteradian(int x, int y, const glm::vec2& st) const;
  void weighCubeMap(const std::vector<ImageRgba>& faces);
  void weighGradient(const shading::Sky& sky);

  int texels_;         // along a face's edge
  int texelsPerCell_;  // along a cell's edge; the last cell may have less
  int cells_;          // along a face's edge
  std::vector<double> weights_;
  double totalWeight_ = 0.0;
};

}  // namespace pb
