// A rendered frame against its truth: everything of a cell that comes from the image.
#pragma once

#include <memory>
#include <optional>

#include "bench/results.h"
#include "bench/truth.h"
#include "raster/technique.h"

namespace pb {

// A measured frame as a renderer shows it, and what is true.
struct RenderedFrame {
  std::shared_ptr<const Image> image;
  std::shared_ptr<const Truth> truth;
  int number;
};

struct ScoreRequest {
  RenderedFrame frame;
  std::optional<RenderedFrame> before{};  // the measured frame before it in the sequence
  std::optional<int> depth{};             // of the truth that matches it, one of Truth::truncated
  const Technique& technique;             // whose probes the objects look up
};

// Fills in the cell's errors and tables. Returns the map of HDR-FLIP.
Plane scoreCell(const ScoreRequest& request, CellResult& cell);

}  // namespace pb
