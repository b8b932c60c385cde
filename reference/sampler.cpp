#include "reference/sampler.h"

#include "reference/sobol.h"

namespace pb {

namespace {

// Dimensions that are stratified jointly. In glass and metal scenes groups of 4 and 8 were alike, 2 and 16 worse.
constexpr std::uint32_t kGroup = kSobolDimensions;
static_assert(kGroup % 2 == 0);

}  // namespace

Sampler Sampler::sobol(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sequence, std::uint32_t index) {
  const std::uint64_t stream = static_cast<std::uint64_t>(pixel) << 32 | sequence;
  Sampler sampler(seed, index, stream);
  sampler.sobol_ = true;
  return sampler;
}

glm::vec2 Sampler::next2() {
  if (sobol_ && dimension_ % kGroup + 1 == kGroup) ++dimension_;  // not across two groups
  const float x = next();
  return {x, next()};
}

// Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: sequences of few dimensions, each group of
// dimensions with its own order of the points and its own scrambles.
float Sampler::nextSobol() {
  const glm::uvec4 order = pcg4d({key_.x, key_.y, key_.z, dimension_ / kGroup});
  const glm::uvec4 scramble = pcg4d({key_.x, key_.y, key_.w, dimension_});
  const std::uint32_t index = reverseBits(scrambleReversed(reverseBits(point_), order.x));
  const int d = static_cast<int>(dimension_++ % kGroup);
  return toFloat(reverseBits(scrambleReversed(reversedSobol(index, d), scramble.y)));
}

}  // namespace pb
