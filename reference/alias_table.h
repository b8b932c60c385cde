// Choice among many things with given probabilities in constant time: Walker's alias method, built by Vose, "A Linear
// Algorithm for Generating Random Numbers with a Given Distribution" (1991).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pb {

// Numbers of bins and thresholds are powers of two, so that uniform numbers that are multiples of 2^-24 choose with
// exactly the probabilities that probability() tells. These differ from the weights' shares by less than 2^-23 / size,
// and are 0 for weights of 0 only.
class AliasTable {
 public:
  static constexpr std::size_t kMaxSize = std::size_t{1} << 24;

  AliasTable() = default;
  // Weights must be finite and not negative, at least one positive, at most kMaxSize.
  explicit AliasTable(const std::vector<double>& weights);

  struct Choice {
    std::uint32_t index;
    float u;  // what is left of uThreshold: uniform in [0, 1) and independent of the index
  };
  // For uniform numbers in [0, 1).
  Choice choose(float uBin, float uThreshold) const;

  double probability(std::size_t index) const { return probabilities_[index]; }
  std::size_t size() const { return probabilities_.size(); }

 private:
  // One column: `threshold` / 2^24 of it belongs to its own number, the rest to `alias`.
  struct Bin {
    std::uint32_t threshold = 0;
    std::uint32_t alias = 0;
  };

  std::vector<Bin> bins_;
  std::vector<float> probabilities_;
};

}  // namespace pb
