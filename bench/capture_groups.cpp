#include "bench/capture_groups.h"

#include <algorithm>
#include <optional>

#include "raster/equal_captures.h"

namespace pb {
namespace {

using Keys = std::vector<std::optional<CaptureKey>>;  // by technique; none: it captures alone

// What techniques have in common that may have equal captures: the key of captures that show nothing.
Keys looseKeys(const std::vector<Technique>& techniques, const Scene& scene, int heightPx) {
  Keys keys;
  for (const Technique& technique : techniques) {
    keys.emplace_back();
    if (mayShareCaptures(technique, scene)) keys.back() = CaptureKeyMaker(technique, heightPx).key();
  }
  return keys;
}

// Without the keys that stand alone, and so need no closer look.
void dropSingle(Keys& keys) {
  const Keys all = keys;
  for (std::optional<CaptureKey>& key : keys)
    if (std::ranges::count(all, key) == 1) key.reset();
}

CaptureGroups groupsOf(const Keys& keys) {
  CaptureGroups groups;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto isOpen = [&](const std::vector<std::size_t>& group) {
      return keys[i] && keys[group.front()] == keys[i] && group.size() < kMostInGroup;
    };
    const auto found = std::ranges::find_if(groups, isOpen);
    if (found == groups.end())
      groups.push_back({i});
    else
      found->push_back(i);
  }
  return groups;
}

}  // namespace

CaptureGroups captureGroups(const std::vector<Technique>& techniques, int first, int last,
                            const SnapshotOfFrame& snapshotOf, int heightPx) {
  if (techniques.size() < 2) return groupsOf(Keys(techniques.size()));
  Keys keys = looseKeys(techniques, *snapshotOf(first)->scene, heightPx);
  dropSingle(keys);
  std::vector<std::optional<CaptureKeyMaker>> makers(techniques.size());
  for (std::size_t i = 0; i < techniques.size(); ++i)
    if (keys[i]) makers[i].emplace(techniques[i], heightPx);
  if (std::ranges::none_of(keys, [](const auto& key) { return key.has_value(); })) return groupsOf(keys);
  for (int frame = first; frame <= last; ++frame) {
    const std::shared_ptr<const Snapshot> snapshot = snapshotOf(frame);
    for (std::optional<CaptureKeyMaker>& maker : makers)
      if (maker) maker->advance(*snapshot);
  }
  for (std::size_t i = 0; i < techniques.size(); ++i)
    if (makers[i]) keys[i] = makers[i]->key();
  return groupsOf(keys);
}

}  // namespace pb
