// Where in an image the error sits together: its largest clusters. Pure functions.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenes/image.h"

namespace pb {

// Pixels that hang together and whose squared error is high.
struct ErrorCluster {
  int x = 0, y = 0, width = 0, height = 0;  // bounding box in pixels, row 0 on top
  std::int64_t pixels = 0;                  // of the cluster itself
  double share = 0;                         // of the image's sum of squared errors, 0 to 1
  std::string object;                       // that most of its pixels show, as ObjectError::object

  friend bool operator==(const ErrorCluster&, const ErrorCluster&) = default;
};

inline constexpr std::size_t kMostClusters = 5;

// High are the largest squared errors (sums over the channels): as many as make up half of the image's sum, but at most
// 5 % of the pixels; those that equal the last of them count as well. They hang together where squares of
// 2 r + 1 pixels around them touch or overlap, r = max(1, height / 90), so that a highlight in pieces is one cluster.
// The largest by share, the upper and then the left one first where shares are equal; none where the images are equal.
// `objects`: what the pixels show, indices into `names` or -1 for the environment.
std::vector<ErrorCluster> findClusters(const Image& reference, const Image& test, const Grid<int>& objects,
                                       const std::vector<std::string>& names);

}  // namespace pb
