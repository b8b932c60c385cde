// Equal things get one number: a hash table with open addressing, as meshes have millions of vertices and edges, and a
// map that allocates for each took most of the time of loading them (docs/performance.md).
#pragma once

#include <xxhash.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

namespace pb {

// Keys are equal if their bytes are: no padding, and -0 is not 0. Numbers count from 0 in the order of first insertion.
template <class Key>
class Numbering {
 public:
  static_assert(std::is_trivially_copyable_v<Key>);

  explicit Numbering(std::size_t expectedKeys = 0) {
    keys_.reserve(expectedKeys);
    std::size_t slots = 16;
    while (slots < 2 * expectedKeys) slots *= 2;
    slots_.assign(slots, kFree);
  }

  std::size_t size() const { return keys_.size(); }

  std::optional<std::uint32_t> find(const Key& key) const {
    const std::uint32_t number = slots_[slotOf(key)];
    return number == kFree ? std::nullopt : std::optional(number);
  }

  // Of the key, which is inserted if it is new.
  std::uint32_t numberOf(const Key& key) {
    if (2 * (keys_.size() + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[slotOf(key)];
    if (slot == kFree) {
      slot = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slot;
  }

 private:
  static constexpr std::uint32_t kFree = ~0U;

  // The key's, or the free one where it would go; half of the slots are free, so there is one.
  std::size_t slotOf(const Key& key) const {
    const std::size_t mask = slots_.size() - 1;  // a power of two less one
    std::size_t at = XXH3_64bits(&key, sizeof key) & mask;
    while (slots_[at] != kFree && std::memcmp(&keys_[slots_[at]], &key, sizeof key) != 0) at = (at + 1) & mask;
    return at;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kFree);
    for (std::uint32_t number = 0; number < keys_.size(); ++number) slots_[slotOf(keys_[number])] = number;
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace pb
