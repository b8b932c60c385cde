// All samples of one primary ray.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "reference/path.h"

namespace pb {

// The paths of one primary ray: estimates of what tracePath() estimates. What needs no random numbers is traced once
// and is the same for all of them: everything up to the surfaces where the first number is drawn. Where smooth surfaces
// reflect and refract, or are only partly there, all ways are followed, as long as each carries a share that matters. A
// sample then is what was found for certain, and one path from one of the surfaces that are left, chosen in proportion
// to what its light weighs. Where no ways part, samples are those of tracePath(), bit for bit.
template <class RayLog>
class BasicPathsOfRay {
 public:
  BasicPathsOfRay(const TracedScene& scene, const Ray& primary, float conePerMetre, const ReferenceSettings& settings,
                  RayLog log = {}) {
    follow(BasicPath<RayLog>(scene, primary, conePerMetre, settings, log));
    while (!pending_.empty()) {
      const BasicPath<RayLog> path = pending_.back();
      pending_.pop_back();
      follow(path);
    }
    share();
  }

  // Whether all samples are the same and draw no numbers.
  bool areCertain() const { return size_ == 0; }

  // One sample. The rays that all have in common are counted with the first.
  PathResult trace(Sampler& sampler) {
    PathResult result{certain_.radiance, std::exchange(certain_.rays, 0)};
    if (areCertain()) return result;
    const Open& open = choose(sampler);
    BasicPath<RayLog> path = open.path;
    if (path.depart(open.arrival, sampler)) path.toTheEnd(sampler);
    result.radiance += path.result().radiance / open.probability;
    result.rays += path.result().rays;
    return result;
  }

 private:
  // A path that has come to where it needs numbers.
  struct Open {
    explicit Open(const BasicPath<RayLog>& path_) : path(path_) {}

    BasicPath<RayLog> path;
    Arrival arrival;
    float probability = 1.0f;
  };

  // More of them gain nothing in `builtin:glass`.
  static constexpr std::size_t kMaxPaths = 8;
  // Of the primary ray's light: what a way must carry to be followed on its own. With a tenth of that `builtin:glass`
  // has 2 to 5 % less noise and takes 5 to 15 % more time.
  static constexpr float kLeastShare = 0.01f;

  // All channels count alike, as after dispersion a path has one alone.
  static float meanOf(const glm::vec3& share) { return (share.x + share.y + share.z) / 3.0f; }

  void follow(const BasicPath<RayLog>& path) {
    Open& open = open_[size_].emplace(path);
    while (open.path.arrive(open.arrival)) {
      if (meanOf(open.path.throughput()) == 0.0f) break;  // all was absorbed: nothing to choose in proportion to
      const std::optional<Ways> ways = open.path.certainWays(open.arrival);
      if (!ways || !mayPart(open.path, ways->all())) {
        ++size_;
        return;
      }
      if (!part(open, ways->all())) break;
    }
    add(open.path);
  }

  bool mayPart(const BasicPath<RayLog>& path, std::span<const ScatteredRay> ways) const {
    if (ways.size() < 2) return true;
    return begun_ + ways.size() - 1 <= kMaxPaths && std::ranges::all_of(ways, [&](const ScatteredRay& way) {
             return meanOf(path.throughput() * way.weight) >= kLeastShare;
           });
  }

  // Goes on by the first way and leaves the others for later; false if there is none.
  bool part(Open& open, std::span<const ScatteredRay> ways) {
    if (ways.empty()) return false;
    for (const ScatteredRay& way : ways.subspan(1)) {
      BasicPath<RayLog> other = open.path;
      other.takeRadiance();
      other.takeRays();
      if (other.take(open.arrival, way)) pending_.push_back(other);
    }
    begun_ += ways.size() - 1;
    return open.path.take(open.arrival, ways.front());
  }

  // Of one open path alone the sum goes on as it would without this class, bit for bit; what several have found so far
  // is certain.
  void share() {
    float sum = 0.0f;
    for (std::size_t i = 0; i < size_; ++i) sum += meanOf(open_[i]->path.throughput());
    for (std::size_t i = 0; i < size_; ++i) {
      BasicPath<RayLog>& path = open_[i]->path;
      if (size_ > 1) {
        open_[i]->probability = meanOf(path.throughput()) / sum;
        certain_.radiance += path.takeRadiance();
      }
      certain_.rays += path.takeRays();
    }
  }

  void add(const BasicPath<RayLog>& path) {
    certain_.radiance += path.result().radiance;
    certain_.rays += path.result().rays;
  }

  const Open& choose(Sampler& sampler) const {
    std::size_t chosen = 0;
    if (size_ > 1)
      for (float u = sampler.next(); chosen + 1 < size_ && u >= open_[chosen]->probability; ++chosen)
        u -= open_[chosen]->probability;
    return *open_[chosen];
  }

  PathResult certain_{glm::vec3(0.0f), 0};
  std::array<std::optional<Open>, kMaxPaths> open_;
  std::size_t size_ = 0;                    // of the open paths
  std::size_t begun_ = 1;                   // paths, open or not
  std::vector<BasicPath<RayLog>> pending_;  // of those: still to be followed
};
using PathsOfRay = BasicPathsOfRay<NoRayLog>;

}  // namespace pb
