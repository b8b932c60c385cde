#include "raster/triangle_lists.h"

#include <algorithm>

namespace pb {
namespace {

constexpr std::size_t kMostIndices = kLargestListBytes / sizeof(std::uint32_t);
constexpr std::size_t kFirstCapacity = std::size_t{1} << 18;

// A triangle less saves llvmpipe 0.02 us or more, looking at one of so few takes 0.006 us: in smaller meshes a list's
// own costs count.
constexpr std::size_t kFewestTriangles = 64;

ShownSides shown(Sides sides) {
  if (sides == Sides::both) return ShownSides::both;
  return sides == Sides::front ? ShownSides::front : ShownSides::back;
}

bool isSameCube(const SampledView& a, const SampledView& b) {
  return a.view.origin == b.view.origin && a.samples == b.samples;
}

}  // namespace

bool isWorthCulling(const Mesh& mesh) {
  return mesh.triangleCount() >= kFewestTriangles && mesh.indices.size() <= kMostIndices;
}

void TriangleLists::beginFrame(const std::vector<gpu::PassConstants>& passes) {
  passes_.clear();
  wasRefusedBefore_ = wasRefused_;
  wasRefused_ = wasCleared_ = false;
  for (const gpu::PassConstants& constants : passes) {
    Pass pass{.view = {.view = constants.view, .samples = glm::vec2(constants.image), .clip = constants.clip},
              .eye = passes_.size()};
    pass.face = cubeFaceOf(pass.view).value_or(-1);
    if (pass.face > 0 && !passes_.empty() && passes_.back().face >= 0 && isSameCube(passes_.back().view, pass.view)) {
      pass.eye = passes_.back().eye;
      pass.view.view = passes_.back().view.view;
    }
    passes_.push_back(pass);
  }
}

IndexRange TriangleLists::visible(std::size_t pass, const SurfaceDraw& draw, const SnapshotInstance& instance,
                                  float share, Sides sides) {
  const GLsizei whole = draw.indexCount(share);
  const auto all = IndexRange{.count = whole};
  if (!draw.mesh->planes.contains(share)) return all;
  const Pass& seen = passes_[pass];
  const Key key{seen.view, instance.worldFromObject, instance.mesh->contentHash, share, sides};
  const auto slot = (std::uint64_t{seen.eye} << 32) + draw.instance;
  if (const auto found = entries_.find(slot); found == entries_.end() || found->second.key != key) {
    if (found == entries_.end() && isFull()) {
      wasRefused_ = true;
      return all;
    }
    Entry entry = found == entries_.end() ? Entry{} : found->second;
    find(key, draw, instance, seen.face >= 0, entry);
    if (!store(entry)) return all;
    entries_.insert_or_assign(slot, entry);
  }
  const Entry& entry = entries_.at(slot);
  const TriangleCuller::Range range = entry.ranges[static_cast<std::size_t>(std::max(seen.face, 0))];
  if (range.count == static_cast<std::size_t>(whole)) return all;
  return {static_cast<GLsizei>(range.count), (entry.first + range.first) * sizeof(std::uint32_t), buffer_.id()};
}

void TriangleLists::find(const Key& key, const SurfaceDraw& draw, const SnapshotInstance& instance, bool isCube,
                         Entry& entry) {
  const PlacedTriangles object{.positions = instance.mesh->positions,
                               .indices = draw.mesh->corners(key.share),
                               .planes = draw.mesh->planes.at(key.share),
                               .worldFromObject = instance.worldFromObject,
                               .worldBounds = instance.worldBounds};
  if (isCube)
    culler_.cullCube(object, key.view, shown(key.sides));
  else
    culler_.cull(object, key.view, shown(key.sides));
  entry.key = key;
  entry.ranges = culler_.ranges();
}

// False if there is no room.
bool TriangleLists::store(Entry& entry) {
  const std::span<const std::uint32_t> indices = culler_.indices();
  if (indices.size() > entry.reserved && !reserve(indices.size(), entry)) return false;
  if (!indices.empty()) buffer_.write(entry.first * sizeof(std::uint32_t), std::as_bytes(indices));
  return true;
}

// A quarter more than asked for, so that what moves seldom needs another place. When the buffer is full, all lists are
// made anew; if a frame fills it twice, what has no list yet is drawn whole until a frame gets along without.
bool TriangleLists::reserve(std::size_t count, Entry& entry) {
  if (count > kMostIndices) return false;
  const std::size_t wanted = std::min(count + count / 4, kMostIndices);
  if (used_ + wanted > capacity_) {
    const std::size_t larger = std::min(std::max({2 * capacity_, kFirstCapacity, wanted}), kMostIndices);
    if (larger == capacity_ && (wasCleared_ || isFull())) {
      wasRefused_ = true;
      return false;
    }
    wasCleared_ = larger == capacity_;
    if (larger > capacity_) buffer_ = gl::Buffer(gl_, larger * sizeof(std::uint32_t));
    capacity_ = larger;
    entries_.clear();
    used_ = 0;
  }
  entry.first = used_;
  entry.reserved = wanted;
  used_ += wanted;
  return true;
}

}  // namespace pb
