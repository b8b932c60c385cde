#include "raster/device.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <limits>

namespace pb {
namespace {

std::unique_ptr<gl::NativeContext> createContext(GlBackend backend) {
  return backend == GlBackend::osmesa ? gl::createOsmesaContext() : gl::createEglContext();
}

// Mesa's rasterisers on the CPU.
bool isSoftware(const std::string& renderer) {
  return std::ranges::any_of(std::array{"llvmpipe", "softpipe", "swrast"},
                             [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

GlInfo readInfo(const gl::Context& context, GlBackend backend) {
  GlInfo info;
  info.backend = backend == GlBackend::osmesa ? "osmesa" : "egl";
  info.renderer = context.text(GL_RENDERER);
  info.vendor = context.text(GL_VENDOR);
  info.version = context.text(GL_VERSION);
  info.software = isSoftware(info.renderer);
  return info;
}

// Software GL takes the process's own memory, and a machine that swaps measures nothing: three quarters of it at most.
// A GPU's driver refuses by itself.
std::int64_t allowedBytes(bool software) {
  if (!software) return std::numeric_limits<std::int64_t>::max();
  return std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE) / 4 * 3;
}

DeviceLimits readLimits(const gl::Context& context, bool software) {
  std::array<GLint, 2> viewport{};
  context.functions().GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
  return {.cubeMapSizePx = context.integer(GL_MAX_CUBE_MAP_TEXTURE_SIZE),
          .arrayLayers = context.integer(GL_MAX_ARRAY_TEXTURE_LAYERS),
          .textureSizePx = context.integer(GL_MAX_TEXTURE_SIZE),
          .viewportPx = std::min(viewport[0], viewport[1]),
          .textureUnits = context.integer(GL_MAX_TEXTURE_IMAGE_UNITS),
          .bytes = allowedBytes(software)};
}

// State that every pass relies on and none changes.
void setInitialState(const gl::Functions& gl) {
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // for the reversed depth of clipFromWorldPosition()
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  gl.Enable(GL_FRAMEBUFFER_SRGB);  // of targets that have such a format: probes with Technique::format = rgba8-srgb
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

}  // namespace

RasterDevice::Impl::Impl(GlBackend backend)
    : context(createContext(backend)),
      info(readInfo(context, backend)),
      limits(readLimits(context, info.software)),
      dropsUnseenTriangles(info.software),
      capturesApart(info.software),
      programs(context) {
  setInitialState(context.functions());
  context.check("setting up the context");
}

// The members free GL objects.
RasterDevice::Impl::~Impl() { context.makeCurrent(); }

std::shared_ptr<SceneResources> RasterDevice::Impl::resourcesOf(const std::shared_ptr<const Scene>& scene) {
  if (resources && resources->scene() == scene) return resources;
  checkSceneFits(limits, *scene);
  resources = std::make_shared<SceneResources>(context, scene);
  return resources;
}

RasterDevice::RasterDevice(GlBackend backend) : impl_(std::make_unique<Impl>(backend)) {}
RasterDevice::~RasterDevice() = default;

const GlInfo& RasterDevice::info() const { return impl_->info; }

}  // namespace pb
