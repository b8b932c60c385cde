#include "reference/sampler.h"

namespace pb {

namespace {

// Dimensions that are stratified jointly. In glass and metal scenes groups of 4 and 8 were alike, 2 and 16 worse.
constexpr std::uint32_t kGroup = kSobolDimensions;
static_assert(kGroup % 2 == 0);

float toFloat(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

glm::uvec4 hashedKey(std::uint64_t seed, std::uint64_t sample) {
  return pcg4d({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32)});
}

}  // namespace

SobolScrambles::SobolScrambles(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sequence)
    : key_(hashedKey(seed, static_cast<std::uint64_t>(pixel) << 32 | sequence)) {}

// Numbers of a path are drawn in order, so that what was computed is a beginning of the dimensions.
std::uint32_t SobolScrambles::ofDimension(std::uint32_t dimension) {
  if (dimension >= kKept) return dimensionScramble(dimension);
  for (; kept_ <= dimension; ++kept_) dimensions_[kept_] = dimensionScramble(kept_);
  return dimensions_[dimension];
}

std::uint32_t SobolScrambles::ofOrder(std::uint32_t group) {
  if (group >= orders_.size()) return orderScramble(group);
  for (; keptOrders_ <= group; ++keptOrders_) orders_[keptOrders_] = orderScramble(keptOrders_);
  return orders_[group];
}

Sampler::Sampler(std::uint64_t seed, std::uint32_t point, std::uint64_t sample)
    : key_(hashedKey(seed, sample)), point_(point) {}

glm::vec2 Sampler::next2() {
  if (scrambles_ != nullptr && dimension_ % kGroup + 1 == kGroup) ++dimension_;  // not across two groups
  const float x = next();
  return {x, next()};
}

float Sampler::nextIndependent() { return toFloat(pcg4d({key_.x, key_.y, point_, key_.z ^ dimension_++}).x); }

// Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: sequences of few dimensions, each group of
// dimensions with its own order of the points and its own scrambles.
float Sampler::nextSobol() {
  const std::uint32_t d = dimension_ % kGroup;
  if (d == 0) index_ = reverseBits(scrambleReversed(point_, scrambles_->ofOrder(dimension_ / kGroup)));
  const std::uint32_t scramble = scrambles_->ofDimension(dimension_++);
  return toFloat(reverseBits(scrambleReversed(reversedSobol(index_, static_cast<int>(d)), scramble)));
}

}  // namespace pb
