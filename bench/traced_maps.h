// Oracle maps that were traced last, for the next cells of the same frame.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bench/oracle.h"

namespace pb {

// Of one scene at one frame. Keeps at most kMostBytes, and the last ones in any case.
class TracedMaps {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 30;

  // As traceMaps(). Valid until the next call.
  const OracleMaps& obtain(const ProbeViews& views, const ReferenceSettings& settings, bool withDistances);
  void clear() { kept_.clear(); }

 private:
  using Kept = std::pair<std::string, OracleMaps>;
  std::size_t totalBytes() const;

  std::vector<Kept> kept_;  // the last used ones last
};

}  // namespace pb
