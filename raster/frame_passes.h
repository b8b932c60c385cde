// The passes of a frame as ScenePass numbers them: the final image, the faces of the probes if they are captured, the
// mirrored views. Pure functions.
#pragma once

#include <vector>

#include "raster/gpu_structs.h"
#include "raster/planar.h"
#include "raster/refresh.h"

namespace pb {

inline constexpr std::size_t kFinalPass = 0;
inline std::size_t capturePass(const ProbeFace& f) { return 1 + static_cast<std::size_t>(6 * f.probe + f.face); }

// Of an image of so many samples.
gpu::PassConstants finalPass(const Snapshot& snapshot, int widthSamples, int heightSamples);
gpu::PassConstants mirroredPass(const Snapshot& snapshot, const MirroredView& mirror, int widthSamples,
                                int heightSamples);

// Of all faces of all probes. resolutions: by probe.
std::vector<gpu::PassConstants> capturePasses(const Technique& technique, const Snapshot& snapshot,
                                              const std::vector<int>& resolutions);

}  // namespace pb
