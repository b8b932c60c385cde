// Frame cost, measured through Google Benchmark with manual time, nothing else running. Method: docs/suites.md.
//
// A repetition is a block of frames between two short blocks of plain frames, so that both see the machine in the same
// state, their ratio is paired, and a drift of its speed cancels to first order. The first frame of a sequence
// (complete capture) and one block of warm-up are not counted.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/results.h"
#include "bench/suite.h"
#include "raster/renderer.h"

namespace pb {

// Quantiles (bench/statistics.h) of the times of single frames: what amortised refresh is about.
CostPeaks peaksOf(std::span<const double> frameMs);

struct CostRequest {
  std::string name;  // of the benchmark
  Technique technique;
  // The first frame of the sequence, then the frames of a block.
  std::vector<std::shared_ptr<const Snapshot>> snapshots;
};

struct CostRun {
  std::vector<CostResult> results;  // one a request
  std::string benchmarkJson;        // Google Benchmark's own schema
};

// Measures at one sample a pixel. `context` is written into the JSON's context; `finished` is called after each
// request. Throws Error(Failure::interrupted) at the next request's boundary after an interrupt.
CostRun measureCosts(RasterDevice& device, const ImageSettings& image, const std::vector<CostRequest>& requests,
                     int repetitions, const std::map<std::string, std::string>& context,
                     const std::function<void()>& finished);

}  // namespace pb
