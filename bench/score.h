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

// Scores of a picture, whoever rendered it. Pictures that are equal in every bit have them in common.
struct PictureScores {
  MetricsResult errors;                  // against the converged truth
  std::optional<MatchedErrors> matched;  // where a depth was given
  double unbiasedMse = 0;
  std::vector<MaterialError> materials;
  std::vector<ErrorCluster> clusters;
};

// depth: of the truth that matches the picture, one of Truth::truncated.
PictureScores scorePicture(const Truth& truth, const Image& image, const std::optional<int>& depth);

struct ScoredFrame {
  RenderedFrame frame;
  std::optional<RenderedFrame> before{};  // the measured frame before it in the sequence
  const Technique& technique;             // whose probes the objects look up
};

// Fills in the cell's errors and tables.
void fillIn(const PictureScores& scores, const ScoredFrame& scored, CellResult& cell);

}  // namespace pb
