#include "bench/attribution_renders.h"

#include <algorithm>

#include "bench/attribution_steps.h"
#include "bench/bounce_depth.h"
#include "bench/capture_groups.h"
#include "raster/lookup.h"

namespace pb {
namespace {

// Everything that traced maps depend on but the depth; the snapshots are of the same scene and frame. Owners: of solid
// glass they count as two hits, hidden or not.
bool areEqual(const ProbeViews& a, const ProbeViews& b) {
  const auto isSameView = [](const ProbeView& x, const ProbeView& y) {
    return x.position == y.position && x.zNear == y.zNear && x.hidden == y.hidden && x.resolutionPx == y.resolutionPx;
  };
  const auto isSameOwner = [](const Probe& x, const Probe& y) { return x.owners == y.owners; };
  return a.snapshot->instances.size() == b.snapshot->instances.size() &&  // else some are cut into parts
         std::ranges::equal(a.probes, b.probes, isSameView) &&
         std::ranges::equal(a.snapshot->probes, b.snapshot->probes, isSameOwner);
}

// A fresh image before it is known with which others it shares its captures.
struct WantedFresh {
  Technique technique;
  int renders;
  std::vector<ImageUse> uses;
};

class RenderCollector {
 public:
  RenderCollector(const std::shared_ptr<const Snapshot>& snapshot, int heightPx)
      : snapshot_(snapshot), heightPx_(heightPx) {}

  void addTraced(const Technique& technique, std::optional<int> depth, const ImageUse& use) {
    ProbeViews views = probeViews(technique, snapshot_, heightPx_);
    const auto isSet = [&](const TracedSet& set) { return set.depth == depth && areEqual(set.views, views); };
    auto set = std::ranges::find_if(traced_, isSet);
    if (set == traced_.end()) set = traced_.insert(set, TracedSet{std::move(views), depth, false, {}});
    set->withDistances = set->withDistances || needsDistances(technique);
    auto image = std::ranges::find(set->images, technique, &TracedImage::technique);
    if (image == set->images.end()) image = set->images.insert(image, TracedImage{technique, {}});
    image->uses.push_back(use);
  }

  void addFresh(const Technique& technique, int depth, const ImageUse& use) {
    const int renders = rendersOf(technique, depth);
    const auto isImage = [&](const WantedFresh& image) {
      return image.renders == renders && image.technique == technique;
    };
    auto image = std::ranges::find_if(fresh_, isImage);
    if (image == fresh_.end()) image = fresh_.insert(image, WantedFresh{technique, renders, {}});
    image->uses.push_back(use);
  }

  AttributionRenders collect(bool sharesCaptures) && { return {std::move(traced_), freshSets(sharesCaptures)}; }

 private:
  // Until maps are as deep, or don't get any deeper: there is no other probe, or none is remembered.
  int rendersOf(const Technique& technique, int depth) const {
    BounceDepth followed(technique, heightPx_);
    const int enough = std::min(depth, kMaxMatchedDepth);
    int renders = 0;
    for (int before = 0, now = 0;; before = now) {
      now = followed.advance(*snapshot_);
      ++renders;
      if (now >= enough || now == before) return renders;
    }
  }

  std::vector<FreshSet> freshSets(bool sharesCaptures) {
    std::vector<Technique> techniques;
    int most = 1;
    for (const WantedFresh& image : fresh_) {
      if (std::ranges::find(techniques, image.technique) == techniques.end()) techniques.push_back(image.technique);
      most = std::max(most, image.renders);
    }
    CaptureGroups groups;
    if (sharesCaptures)
      groups = captureGroups(
          techniques, 0, most - 1, [&](int) { return snapshot_; }, heightPx_);
    else
      for (std::size_t i = 0; i < techniques.size(); ++i) groups.push_back({i});
    std::vector<FreshSet> sets;
    for (const std::vector<std::size_t>& group : groups) {
      FreshSet& set = sets.emplace_back();
      for (const std::size_t i : group) addImages(techniques[i], set);
    }
    return sets;
  }

  void addImages(const Technique& technique, FreshSet& set) {
    for (WantedFresh& image : fresh_)
      if (image.technique == technique)
        set.images.push_back({set.techniques.size(), image.renders, std::move(image.uses)});
    set.techniques.push_back(technique);
  }

  const std::shared_ptr<const Snapshot>& snapshot_;
  int heightPx_;
  std::vector<TracedSet> traced_;
  std::vector<WantedFresh> fresh_;
};

}  // namespace

std::optional<int> truncatedDepth(const TruthSettings& truth, int depth) {
  if (depth >= kMaxMatchedDepth || (truth.depth && *truth.depth <= depth)) return truth.depth;
  return depth;
}

int FreshSet::renders() const { return std::ranges::max(images, {}, &FreshImage::renders).renders; }

std::size_t AttributionRenders::imageCount() const {
  std::size_t count = 0;
  for (const TracedSet& set : traced) count += set.images.size();
  for (const FreshSet& set : fresh) count += set.images.size();
  return count;
}

AttributionRenders attributionRenders(const std::vector<AttributedCell>& cells,
                                      const std::shared_ptr<const Snapshot>& snapshot, int tracedResolution,
                                      int heightPx, bool sharesCaptures) {
  RenderCollector collector(snapshot, heightPx);
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    for (const RasterStep& step : rasterSteps(cells[cell].technique, tracedResolution))
      if (step.isTraced)
        collector.addTraced(step.technique, cells[cell].truncated, {cell, step.step});
      else
        collector.addFresh(step.technique, cells[cell].depth, {cell, step.step});
  return std::move(collector).collect(sharesCaptures);
}

}  // namespace pb
