// What a sequence consists of; see raster/renderer.h.
#pragma once

#include <optional>
#include <vector>

#include "raster/device.h"
#include "raster/final_image.h"
#include "raster/frame_work.h"
#include "raster/planar.h"
#include "raster/planar_images.h"
#include "raster/probe_captures.h"
#include "raster/probe_layout.h"
#include "raster/scene_pass.h"

namespace pb {

// Throws an input Error for settings that no sequence can have, whatever the device and the scene.
void checkSettings(const Technique& technique);

struct RasterSequence::Impl {
  Impl(RasterDevice::Impl& device_, const Technique& technique_, int widthPx, int heightPx, int samplesPerAxis);
  ~Impl() { device.context.makeCurrent(); }  // the members free GL objects

  FrameStats renderFrame(const Snapshot& sceneSnapshot, FrameWork& work);
  // The same without the final image, and without what only that shows.
  void captureFrame(const Snapshot& sceneSnapshot, FrameWork& work);
  // For the fragments that `work` counts, if it shall.
  const gl::Functions* fragmentCount(bool isWanted);

  // The first half of a frame, up to the captures; `snapshot` is laid out.
  void capture(const Snapshot& snapshot, FrameWork& work);
  std::vector<gpu::PassConstants> passesOf(const Snapshot& snapshot) const;
  void drawMirroredViews(const Snapshot& snapshot, FrameWork& work);
  void drawFinalImage(FrameWork& work);

  RasterDevice::Impl& device;
  const Programs::Use programs;
  const Technique technique;
  std::optional<ScenePass> scenePass;
  std::optional<ProbeCaptures> captures;
  std::optional<FinalImage> image;
  std::optional<PassTimer> timer;
  ProbeLayout layout;
  std::vector<MirroredView> mirrors;  // of this frame
  std::size_t firstMirroredPass = 0;
  std::optional<PlanarImages> mirrorImages;
  std::vector<GLuint> mirrorImageOfInstance;  // by instance: 0 for those that show none
};

}  // namespace pb
