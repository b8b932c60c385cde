// A small run with every optional part of the results once there and once not.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bench/results.h"

namespace pb::samples {

// Numbers that don't survive six digits.
inline Metrics makeMetrics(double error) {
  Metrics metrics;
  metrics.sums = {-error / 3, error * error, error, error / 7, 0.1 + error, 20.0 + error, error / 10, error / 11};
  metrics.ssim = Ssim{{0.9, 1.0 / 3.0, 0.7}, 2.0 / 3.0, 0.8};
  metrics.msSsim = 0.99;
  metrics.flipLdr = {error, 0.1 * error, 0.2 * error, 0.3 * error, 0.0, 0.9};
  metrics.flipHdr = FlipPooled{2 * error, 0.1 * error, 0.2 * error, 0.3 * error, 0.0, 1.0};
  metrics.ppd = 67.02064327658225;
  metrics.startExposure = -2.5;
  metrics.stopExposure = 1.0 / 3.0;
  metrics.numExposures = 4;
  return metrics;
}

// Six repetitions about `ratio`, spread by a factor of `spread` either way.
inline std::vector<double> repetitionsAbout(double ratio, double spread) {
  return {ratio / spread, ratio, ratio * spread, ratio, ratio * spread, ratio / spread};
}

inline CostResult makeCost(double ratio) {
  CostResult cost;
  cost.repetitions = 6;
  cost.plainMs = 4.0;
  cost.frameMs = ratio * cost.plainMs;
  cost.frameMsLow = 0.98 * cost.frameMs;
  cost.frameMsHigh = 1.02 * cost.frameMs;
  cost.ratio = ratio;
  cost.ratioLow = 0.98 * ratio;
  cost.ratioHigh = 1.02 * ratio;
  cost.ratios = repetitionsAbout(ratio, 1.02);
  cost.shadowMs = 0.0625;
  cost.captureMs = {0.5, 0.25};
  cost.prefilterMs = 0.125;
  cost.finalMs = 3.5;
  cost.rendersPerFrame = 13;
  cost.measuredRendersPerFrame = 13;
  cost.rendersFormula = "6*N*B+1 = 13";
  cost.peaks = CostPeaks{cost.frameMs, 1.5 * cost.frameMs, 1.75 * cost.frameMs, 2 * cost.frameMs};
  return cost;
}

inline CellResult makeCell(const std::string& scene, int frame, const std::string& resolution,
                           const std::string& refresh, double error) {
  CellResult cell;
  cell.scene = scene;
  cell.camera = "main";
  cell.frame = frame;
  cell.technique = {{"resolution", resolution}, {"refresh", refresh}, {"bounces", "1"}};
  cell.metrics = makeMetrics(error);
  cell.maskMetrics = makeMetrics(4 * error);
  cell.floor = {{"mse", 1e-9}, {"relmse", 1.0 / 3e6}};
  cell.maskFloor = {{"mse", 2e-9}, {"relmse", 1e-6}};
  cell.unbiased = {{"mse", error * error}};
  cell.counters = {{"faces_captured", 12}, {"draws", 40}, {"triangles", 123456}, {"probe_bytes", 2 * 1024 * 1024}};
  cell.faceAgeFrames = {{0, 0, 0, 0, 0, 0}, {5, 0, 2, -1, 5, 3}};
  cell.coatsOfProbes = {3, 0};
  return cell;
}

inline MatchedErrors makeMatched(double error) {
  return {.depth = 2,
          .converged = false,
          .metrics = makeMetrics(error / 2),
          .maskMetrics = makeMetrics(2 * error),
          .floor = {{"relmse", 1e-7}},
          .maskFloor = {{"relmse", 2e-7}}};
}

inline std::vector<ObjectError> makeObjects() {
  return {{{120, 0.02, 0.03, -0.01, 0.1, 0.75}, "ball", "chrome", 1, 0.5, 0.25},
          {{1000, 0.002, 0.003, 0.001, 0.01, 0.25}, "environment", "", std::nullopt, std::nullopt, 0.0}};
}

inline Provenance makeProvenance() {
  Provenance p;
  p.toolVersion = "0.1.0";
  p.gitHash = "0123abc";
  p.suiteName = "quick";
  p.suiteHash = "feed";
  p.startedAt = "2026-01-31T12:00:00Z";
  p.cpu = "CPU with \"quotes\"";
  p.threads = 2;
  p.glBackend = "osmesa";
  p.glRenderer = "llvmpipe (LLVM 15.0.6, 256 bits)";
  p.glVersion = "4.5 Mesa 22.3.6";
  p.libraries = {{"Embree", "3.13.5"}, {"OpenImageIO", "2.4.7"}};
  p.sceneHashes = {{"builtin:a", "aaaa"}};
  p.settings = {{"size", "640x360"}, {"samples", "4"}};
  p.seed = 0xffffffffffffffffU;  // does not fit a double
  p.maxNoise = 1e-5;
  p.controlOutcome = kControlPassed;
  return p;
}

// Two frames, two resolutions, two refresh policies of scene a; one cell without mask, cost and floor of scene b.
inline Results makeResults() {
  Results results;
  results.provenance = makeProvenance();
  Tolerance plain{Tolerance::Kind::plain, 1e-4, 0.02, {}};
  Tolerance tree{Tolerance::Kind::any, 0, 0, {plain, {Tolerance::Kind::all, 0, 0, {plain, plain}}}};
  results.tolerance = {{"flip_hdr", plain}, {"relmse", tree}};
  double error = 0.1;
  for (const char* resolution : {"64", "128"}) {
    for (const char* refresh : {"every-frame", "static"}) {
      const double ratio = refresh == std::string("static") ? 1.0 / 0.9 : 3.0;
      for (int frame = 0; frame < 2; ++frame) {
        results.cells.push_back(makeCell("builtin:a", frame, resolution, refresh, error));
        CellResult& cell = results.cells.back();
        cell.cost = makeCost(ratio);
        cell.matched = makeMatched(error);
        cell.intervals = {{"flip_hdr", {1.9 * error, 2.1 * error}}, {"ssim", {0.5, 2.0 / 3.0}}};
        cell.maskIntervals = {{"flip_hdr", {7.9 * error, 8.1 * error}}};
        cell.replicates = {{"flip_hdr", {1.99 * error, 2.01 * error}}, {"ssim", {0.6, 1.0 / 3.0}}};
        cell.maskReplicates = {{"flip_hdr", {7.99 * error, 8.01 * error}}};
        cell.referenceHash = frame == 0 ? "00ff" : "01ff";
        cell.materials = {{{120, 0.02, 0.03, -0.01, 0.1, 0.75}, "chrome"}};
        cell.objects = makeObjects();
        cell.clusters = {{10, 20, 8, 4, 30, 0.5, "ball"}, {0, 0, 1, 1, 1, 0.125, "environment"}};
        if (frame > 0) cell.flicker = Flicker{error / 5, error / 3};
        error *= 0.9;
      }
    }
  }
  CellResult bare = makeCell("builtin:b", 0, "64", "every-frame", 0.0);
  bare.maskMetrics.reset();
  bare.maskFloor.clear();
  bare.floor.clear();
  bare.metrics.sums.psnr = std::numeric_limits<double>::infinity();
  bare.metrics.ssim.reset();
  bare.metrics.msSsim.reset();
  bare.metrics.flipHdr.reset();
  bare.metrics.startExposure = bare.metrics.stopExposure = 0;
  bare.metrics.numExposures = 0;
  results.cells.push_back(bare);
  return results;
}

}  // namespace pb::samples
