// Where an image's error comes from: the error of a chain of images, each with one approximation more than the one
// before, from the truth to the technique as it was run. What each image is: docs/attribution.md.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace pb {

// The errors of one image of the chain against the converged truth. The bar of a step is the difference to the step
// before, the first one's to 0: it may be negative, and all bars sum to the last step's errors.
struct AttributionStep {
  std::string step;                                         // a name of attributionSteps()
  std::vector<std::pair<std::string, double>> metrics;      // by the keys of metricTable(); undefined ones are left out
  std::vector<std::pair<std::string, double>> maskMetrics;  // empty without reflective or refractive objects in sight

  friend bool operator==(const AttributionStep&, const AttributionStep&) = default;
};

// The same over the pixels that show one object: "mse", "relmse", "bias" and "flip_hdr".
struct ObjectAttribution {
  std::string object, material;
  std::int64_t pixels = 0;
  std::vector<AttributionStep> steps;

  friend bool operator==(const ObjectAttribution&, const ObjectAttribution&) = default;
};

// Of one cell.
struct Attribution {
  std::string scene, camera;
  int frame = 0;
  std::vector<std::pair<std::string, std::string>> technique;  // as the cell's
  int depth = 0;                                               // specular hits of the truncated truth, 0: all
  std::vector<AttributionStep> steps;                          // in the order of the chain
  std::vector<ObjectAttribution> objects;                      // by instance of the scene, those in sight

  friend bool operator==(const Attribution&, const Attribution&) = default;
};

struct AttributionStepInfo {
  std::string name;
  std::string meaning;  // one line: what this step's image approximates that the one before doesn't
};

// All steps there are, in order. Those that don't apply to a technique are left out of its chain.
const std::vector<AttributionStepInfo>& attributionSteps();

// One line of text, as it stands in results.json and in a run's journal; inverse to each other.
std::string toJson(const Attribution& attribution);
Attribution attributionFromJson(const std::string& text, const std::string& place);

}  // namespace pb
