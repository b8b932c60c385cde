// What a path is inside of: refractive objects that may be nested, by instance.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "scenes/snapshot.h"

namespace pb {

// The inside of a refractive object, or the vacuum outside of everything. Trivial, so that a path's stack costs nothing
// until it is used.
struct Medium {
  int instance;              // -1: vacuum
  int node;                  // of the instance
  const Material* material;  // null: vacuum

  float ior() const { return material == nullptr ? 1.0f : material->constants.kind.y; }         // at 587.6 nm
  float dispersion() const { return material == nullptr ? 0.0f : material->constants.kind.w; }  // 20 / Abbe number
  glm::vec3 absorption() const {                                                                // 1/m
    return material == nullptr ? glm::vec3(0.0f) : glm::vec3(material->constants.absorption);
  }
};
inline constexpr Medium kVacuum{-1, -1, nullptr};

// The media around a point, the last one entered innermost: where objects overlap, the one entered last fills the
// overlap. No heap; of more than kCapacity nested objects the outermost is forgotten.
class MediumStack {
 public:
  const Medium& innermost() const { return size_ == 0 ? kVacuum : media_[size_ - 1]; }

  bool contains(const Medium& medium) const { return find(medium) < size_; }

  // Does nothing if the path is already inside.
  void enter(const Medium& medium) {
    if (contains(medium)) return;
    if (size_ == kCapacity) erase(0);
    media_[size_++] = medium;
  }

  void leave(const Medium& medium) {
    if (const std::size_t i = find(medium); i < size_) erase(i);
  }

 private:
  static constexpr std::size_t kCapacity = 8;

  // Index of the instance's entry. An object may also be left through another instance than it was entered by, where
  // one mesh of a file holds its surface in several parts: then the innermost of the same node and material is meant.
  std::size_t find(const Medium& medium) const {
    for (std::size_t i = size_; i-- > 0;)
      if (media_[i].instance == medium.instance) return i;
    for (std::size_t i = size_; i-- > 0;)
      if (media_[i].node == medium.node && media_[i].material == medium.material) return i;
    return size_;
  }

  void erase(std::size_t index) {
    std::move(media_.begin() + static_cast<std::ptrdiff_t>(index) + 1,
              media_.begin() + static_cast<std::ptrdiff_t>(size_), media_.begin() + static_cast<std::ptrdiff_t>(index));
    --size_;
  }

  std::array<Medium, kCapacity> media_;
  std::size_t size_ = 0;
};

}  // namespace pb
