// What the attributions of one frame of a scene render: every image, every set of traced maps and all captures that are
// equal once, whichever cells they are of. Pure: the runner renders what stands here, the plan counts it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/suite.h"
#include "raster/probe_views.h"
#include "raster/technique.h"

namespace pb {

// A cell of the frame.
struct AttributedCell {
  Technique technique;
  int depth = 0;                   // specular hits that it follows: bench/bounce_depth.h
  std::optional<int> truncated{};  // the same as a setting of the reference: truncatedDepth()
};

// The depth of the truth that has as many bounces; that of the truth itself where it has no more.
std::optional<int> truncatedDepth(const TruthSettings& truth, int depth);

// Whose image it is, and of which step.
struct ImageUse {
  std::size_t cell;
  std::string step;  // a name of attributionSteps()

  friend bool operator==(const ImageUse&, const ImageUse&) = default;
};

// Shows maps that are traced.
struct TracedImage {
  Technique technique;  // ProbeUse::given
  std::vector<ImageUse> uses;
};

// Images that show the same maps.
struct TracedSet {
  ProbeViews views;
  std::optional<int> depth;    // of images that show them
  bool withDistances = false;  // some of the techniques read them
  std::vector<TracedImage> images;
};

// Shows maps that are captured afresh, after so many renders of a world that stands still: as many as it takes for the
// maps to be as deep as the cell's.
struct FreshImage {
  std::size_t technique;  // index into FreshSet::techniques
  int renders;
  std::vector<ImageUse> uses;
};

// Images with equal captures, for a SharedSequence.
struct FreshSet {
  std::vector<Technique> techniques;
  std::vector<FreshImage> images;

  int renders() const;  // of the image that takes most
};

struct AttributionRenders {
  std::vector<TracedSet> traced;
  std::vector<FreshSet> fresh;

  std::size_t imageCount() const;
};

// sharesCaptures: no, where a fault is planted (see SharedSequence). heightPx: of the image.
AttributionRenders attributionRenders(const std::vector<AttributedCell>& cells,
                                      const std::shared_ptr<const Snapshot>& snapshot, int tracedResolution,
                                      int heightPx, bool sharesCaptures = true);

}  // namespace pb
