// Where it pays to look for the environment's light: cells of the six cube faces, weighted by what their radiance is
// above the mean of the sphere. What is no brighter than that is left to directions that the surface itself prefers:
// Karlik et al., "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance Sampling", TOG 38(6), 2019.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "scenes/scene.h"

namespace pb {

// So estimates need the other directions as well. Cube maps are read with a bilinear filter: a cell's radiance is the
// mean of the filtered one, so that a dark texel beside a bright one has its share. A gradient is averaged over 4 x 4
// points.
class EnvironmentDensity {
 public:
  explicit EnvironmentDensity(const Environment& environment);

  // Luminance above the mean times solid angle, by cell; empty after forgetWeights(). All 0 if that is less than 1 % of
  // the light: nothing stands out then.
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
  struct Light {
    double flux = 0.0;  // luminance times solid angle
    double solidAngle = 0.0;
  };
  std::vector<Light> lightOfCubeMap(const std::vector<ImageRgba>& faces) const;
  std::vector<Light> lightOfGradient(const shading::Sky& sky) const;

  int texels_;         // along a face's edge
  int texelsPerCell_;  // along a cell's edge; the last cell may have less
  int cells_;          // along a face's edge
  std::vector<double> weights_;
  double totalWeight_ = 0.0;
};

}  // namespace pb
