// The reference store: ray-traced truths on disk, addressed by everything that changes the picture, never by name.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "reference/adaptive.h"
#include "reference/renderer.h"

namespace pb {

// Picture number `pass` (from 1 on) of a reference that adds samples until it is quiet enough. Its sample map follows
// from the passes before.
struct Refinement {
  int pass;
  AdaptiveGoal goal;
  SampleMap samples;
};

struct ReferenceRequest {
  std::shared_ptr<const Snapshot> snapshot;
  int widthPx = 0, heightPx = 0;
  ReferenceSettings settings;  // of the first picture, also in those that refine it
  std::optional<Refinement> refinement{};
};

// $XDG_CACHE_HOME/probebench/references, else ~/.cache/probebench/references; an environment Error if neither is set.
std::filesystem::path defaultStoreFolder();

class ReferenceStore {
 public:
  explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Everything that changes the picture of a request, as text. Equal texts mean equal pictures.
  static std::string describe(const ReferenceRequest& request);

  // The stored image with all its batches; nullopt if there is none, or if what is there is incomplete or damaged,
  // which is said in `warning`.
  std::optional<ReferenceImage> load(const ReferenceRequest& request, std::string& warning) const;

  // Whether there is an entry; it may still turn out to be damaged.
  bool contains(const ReferenceRequest& request) const;

  // Throws an environment Error that names the folder when it can't be written.
  void save(const ReferenceRequest& request, const ReferenceImage& image) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path entry(const ReferenceRequest& request) const;

  std::filesystem::path folder_;
};

}  // namespace pb
