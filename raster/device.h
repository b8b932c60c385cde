// What lives as long as a GL context: its limits, compiled programs, and the last scene's resources.
#pragma once

#include <memory>

#include "raster/fault.h"
#include "raster/gl/context.h"
#include "raster/limits.h"
#include "raster/programs.h"
#include "raster/renderer.h"
#include "raster/scene_resources.h"

namespace pb {

struct RasterDevice::Impl {
  explicit Impl(GlBackend backend);
  ~Impl();

  // Uploads the scene unless it is the one of the call before.
  std::shared_ptr<SceneResources> resourcesOf(const std::shared_ptr<const Scene>& scene);

  gl::Context context;
  GlInfo info;
  DeviceLimits limits;
  bool dropsUnseenTriangles;  // raster/triangle_lists.h; false on GPUs
  bool capturesApart;         // small maps, see ProbeMaps; likewise
  Programs programs;
  std::shared_ptr<SceneResources> resources;
  PlantedFault fault;
};

}  // namespace pb
