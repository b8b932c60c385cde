// The control: a scene in which nothing is approximated must be the same picture in both renderers.
#include <iterator>

#include "bench/certify.h"
#include "bench/certify/common.h"
#include "bench/metrics/metrics.h"
#include "scenes/builtin.h"

namespace pb {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
// Samples along a pixel's edge: all that certification's table is about; before a suite, fewer. What makes the
// renderers differ (a formula, a transform, a light, a texture) shows at any number above one, which is needed to see
// them averaged: with 2 a control takes 1 instead of 3 s, and its relMSE stays within a factor of 3.
constexpr int kCertifiedSamples = 4;
constexpr int kSamplesBeforeSuites = 2;

// Pixels in which some sample shows something else in one renderer than in the other.
struct Disagreement {
  Mask kept;               // pixels in which all samples agree
  double otherObject = 0;  // share of all pixels
  double any = 0;          // another object, smoothing group or nearest texel
};

Disagreement compareIds(const Grid<SampleId>& raster, const Grid<SampleId>& reference, int samples) {
  Disagreement result;
  result.kept = Mask(kWidth, kHeight, 1);
  int objects = 0, all = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      bool otherObject = false, other = false;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const SampleId& a = raster(x * samples + i, y * samples + j);
          const SampleId& b = reference(x * samples + i, y * samples + j);
          otherObject |= a.instance != b.instance;
          other |= a != b;
        }
      objects += otherObject;
      all += other;
      if (other) result.kept(x, y) = 0;
    }
  const double pixels = static_cast<double>(kWidth) * kHeight;
  result.otherObject = objects / pixels;
  result.any = all / pixels;
  return result;
}

// What the renderers may differ by: float rounding, which llvmpipe shows as relMSE 3e-13 without and 3e-11 with
// textures. The bounds leave room for other drivers, and stay far below any error that a table shows.
std::vector<Check> compareControl(RasterDevice& device, const std::string& name, const Spec& spec, double relmseBound,
                                  int samples) {
  auto scene = std::make_shared<const Scene>(makeBuiltinScene(spec));
  const std::shared_ptr<const Snapshot> snapshot =
      makeSnapshot(std::move(scene), 0, "", static_cast<double>(kWidth) / kHeight);
  RasterSequence sequence(device, Technique{}, kWidth, kHeight, samples);
  sequence.renderFrame(*snapshot);
  const Image raster = sequence.readImage();

  const ReferenceScene referenceScene(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = samples;
  settings.spp = 2;
  const Image reference = referenceScene.render(snapshot->camera, kWidth, kHeight, settings).mean();
  const Disagreement ids = compareIds(sequence.renderIds(*snapshot),
                                      referenceScene.renderIds(snapshot->camera, kWidth, kHeight, samples), samples);

  const ErrorSums sums = computeErrorSums(reference, raster, &ids.kept);
  const double flip = poolFlip(computeFlipLdr(reference, raster).map, &ids.kept).mean;
  const std::string subject = "raster vs reference";
  return {
      {name, subject, "relMSE", sums.relmse, 0.0, relmseBound},
      {name, subject, "LDR-FLIP mean", flip, 0.0, 1e-3},
      {name, subject, "share of pixels with another object", ids.otherObject, 0.0, 5e-4},
      {name, subject, "share of pixels left out", ids.any, 0.0, 2e-3},
  };
}

void append(std::vector<Check>& checks, std::vector<Check> more) {
  checks.insert(checks.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<Check> compareOpaque(RasterDevice& device, int samples) {
  std::vector<Check> checks =
      compareControl(device, "control, untextured", {"control", {{"textures", "0"}}}, 1e-6, samples);
  append(checks, compareControl(device, "control, textured", {"control", {}}, 1e-5, samples));
  return checks;
}

}  // namespace

std::vector<Check> runControl(RasterDevice& device) { return compareOpaque(device, kSamplesBeforeSuites); }

std::vector<Check> certifyControl(RasterDevice& device) {
  constexpr int kSamples = kCertifiedSamples;
  std::vector<Check> checks = compareOpaque(device, kSamples);
  append(checks, compareControl(device, "control, transparent", {"control-alpha", {}}, 1e-5, kSamples));
  // Shadow maps are an approximation.
  std::vector<Check> shadows = compareControl(device, "control, shadows", {"control-shadows", {}}, 1e-5, kSamples);
  for (Check& check : shadows) check.binding = false;
  append(checks, std::move(shadows));
  return checks;
}

}  // namespace pb
