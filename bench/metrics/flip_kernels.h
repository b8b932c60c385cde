// The one-dimensional filter kernels of FLIP for a number of pixels per degree.
#pragma once

#include <array>
#include <vector>

namespace pb::flip {

enum class Symmetry {
  even,       // weight_i (f(-i) + f(i))
  odd,        // weight_i (f(-i) - f(i))
  curvature,  // weight_i (f(-i) + f(i) - 2 f(0)): an even kernel of sum 0, exactly 0 where the signal is constant
};

// One half of a symmetric kernel: weights[i] belongs to offsets -(firstOffset + i) and +(firstOffset + i). An even
// kernel starts at offset 0 with half of its centre weight, which the pair f(0) + f(0) counts twice.
struct Kernel {
  Symmetry symmetry = Symmetry::even;
  int firstOffset = 0;
  std::vector<float> weights;

  int radius() const { return firstOffset + static_cast<int>(weights.size()) - 1; }
};

// The contrast sensitivity filters of the opponent channels y, cx and cz, that of cz being the sum of two Gaussians;
// then the feature detectors' Gaussian and its first (edges) and second (points) derivative.
enum KernelName { kAchromatic, kRedGreen, kBlueYellow1, kBlueYellow2, kSmooth, kEdge, kPoint, kKernelCount };

struct Kernels {
  std::array<Kernel, kKernelCount> kernels;
  int radius = 0;  // the largest of all

  const Kernel& operator[](KernelName name) const { return kernels[name]; }
};

// ppd in [1, 1000].
Kernels makeKernels(double ppd);

}  // namespace pb::flip
