// Scores of the images of one frame against its truth: equal ones are scored once.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/attribution.h"
#include "bench/truth.h"

namespace pb {

class AttributionScores {
 public:
  explicit AttributionScores(std::shared_ptr<const Truth> truth) : truth_(std::move(truth)) {}

  // Equal for images that are equal in every bit, and stays valid.
  struct Scored {
    std::vector<std::pair<std::string, double>> metrics, maskMetrics;
    std::vector<ObjectError> objects;
  };
  const Scored& score(const Image& image);

  const Truth& truth() const { return *truth_; }

 private:
  std::shared_ptr<const Truth> truth_;
  std::map<std::string, Scored> scored_;  // by the hash of the image, which need not be kept
};

// Adds a step to an attribution.
void addStep(const std::string& step, const AttributionScores::Scored& scored, Attribution& attribution);

}  // namespace pb
