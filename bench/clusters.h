// Where in an image the error sits together: its largest clusters. Method: docs/results.md.
#pragma once

#include <cstdint>
#include <string>

namespace pb {

// Pixels that hang together and whose squared error is high.
struct ErrorCluster {
  int x = 0, y = 0, width = 0, height = 0;  // bounding box in pixels, row 0 on top
  std::int64_t pixels = 0;                  // of the cluster itself
  double share = 0;                         // of the image's sum of squared errors, 0 to 1
  std::string object;                       // that most of its pixels show, as ObjectError::object

  friend bool operator==(const ErrorCluster&, const ErrorCluster&) = default;
};

}  // namespace pb
