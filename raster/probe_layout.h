// Which probes a technique gives a snapshot: where they stand, who owns them. Pure functions but for a cache of meshes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

// Throws an input Error for a Technique::sharing that is none.
void checkSharing(const Spec& sharing);

class ProbeLayout {
 public:
  explicit ProbeLayout(const Technique& technique);

  // The snapshot with the technique's probes in the place of its own: instances cut into parts
  // (Technique::selfReflection), probes moved (placement), then joined (sharing). The snapshot itself where the
  // technique wants nothing of that. Valid until the next call, and as long as the snapshot.
  const Snapshot& apply(const Snapshot& snapshot);

 private:
  void splitOwners(Snapshot& snapshot);
  std::vector<std::shared_ptr<const Mesh>> partsOf(const std::shared_ptr<const Mesh>& mesh);

  Technique technique_;
  std::optional<Snapshot> laidOut_;
  std::map<std::shared_ptr<const Mesh>, std::vector<std::shared_ptr<const Mesh>>> parts_;
};

// Parts that an instance is cut into at most.
inline constexpr std::size_t kMaxParts = 8;

}  // namespace pb
