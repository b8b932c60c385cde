// The image files of a cell: paths relative to the run's folder, with '/'; empty where a picture was not kept.
#pragma once

#include <string>

namespace pb {

struct CellPictures {
  std::string reference;  // OpenEXR, linear
  std::string rendered;   // OpenEXR, linear
  std::string flip;       // PNG: the map of HDR-FLIP in magma

  friend bool operator==(const CellPictures&, const CellPictures&) = default;
};

}  // namespace pb
