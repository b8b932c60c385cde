#include "raster/probe_maps.h"

#include <algorithm>

namespace pb {
namespace {

gl::Texture makeCubes(const gl::Functions& gl, int resolution, int probes, int levels) {
  return gl::makeTexture(gl, {.target = GL_TEXTURE_CUBE_MAP_ARRAY,
                              .format = GL_RGBA16F,
                              .width = resolution,
                              .height = resolution,
                              .layers = 6 * probes,
                              .levels = levels});
}

GLint layerOf(const ProbeFace& face) { return 6 * face.probe + face.face; }

}  // namespace

ProbeMaps::ProbeMaps(gl::Context& context, Programs& programs, int resolution, int probes, bool doubleBuffered,
                     ProbeFilter filter)
    : gl_(context.functions()),
      resolution_(resolution),
      levels_(filteredLevels(filter, resolution)),
      shown_(makeCubes(gl_, resolution, probes, levels_ + 1)),
      back_(doubleBuffered ? makeCubes(gl_, resolution, probes, 1) : gl::Texture()),
      depth_(gl::makeTexture(
          gl_, {.target = GL_TEXTURE_2D, .format = GL_DEPTH_COMPONENT32F, .width = resolution, .height = resolution})),
      unfiltered_(static_cast<std::size_t>(probes), 0) {
  if (levels_ > 0) {
    shownLayers_ = gl::makeView(shown_, {GL_TEXTURE_2D_ARRAY, GL_RGBA16F, levels_ + 1, 6 * probes});
    filter_.emplace(context, programs, filter, GL_RGBA16F, resolution);
  }
  context.check("allocating cube maps");
  framebuffer_ = gl::makeLayerFramebuffer(gl_, captured(), depth_);
}

void ProbeMaps::bind() const { gl_.BindTextureUnit(gpu::kProbeUnit, shown_.id()); }

RenderTarget ProbeMaps::target(const ProbeFace& face) {
  gl::setColorLayer(framebuffer_, captured(), layerOf(face));
  return {framebuffer_.id(), resolution_, resolution_};
}

void ProbeMaps::publish(const std::vector<ProbeFace>& captured) {
  for (const ProbeFace& face : captured) unfiltered_[static_cast<std::size_t>(face.probe)] |= 1u << face.face;
  // Single-buffered captures are read in the texture that they were drawn to.
  if (back_.id() == 0) return gl_.TextureBarrier();
  for (const ProbeFace& face : captured)
    gl_.CopyImageSubData(back_.id(), GL_TEXTURE_CUBE_MAP_ARRAY, 0, 0, 0, layerOf(face), shown_.id(),
                         GL_TEXTURE_CUBE_MAP_ARRAY, 0, 0, 0, layerOf(face), resolution_, resolution_, 1);
}

bool ProbeMaps::isStale(const std::vector<bool>& wanted) const {
  if (!filter_) return false;
  for (std::size_t probe = 0; probe < unfiltered_.size(); ++probe)
    if (wanted[probe] && unfiltered_[probe] != 0) return true;
  return false;
}

std::int64_t ProbeMaps::filter(const std::vector<bool>& wanted) {
  if (!isStale(wanted)) return 0;
  std::int64_t texels = 0;
  for (std::size_t probe = 0; probe < unfiltered_.size(); ++probe) {
    if (!wanted[probe] || unfiltered_[probe] == 0) continue;
    texels += filter_->run(shownLayers_, static_cast<int>(probe), unfiltered_[probe]);
    unfiltered_[probe] = 0;
  }
  return texels;
}

std::array<Image, 6> ProbeMaps::read(int probe, int level) const {
  const int size = std::max(resolution_ >> level, 1);
  const std::size_t texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  std::vector<glm::vec3> faces(6 * texels);
  gl_.GetTextureSubImage(shown_.id(), level, 0, 0, layerOf({probe, 0}), size, size, 6, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(faces.size() * sizeof(glm::vec3)), faces.data());
  std::array<Image, 6> images;
  for (std::size_t face = 0; face < images.size(); ++face) {
    images[face] = Image(size, size);
    std::copy_n(faces.begin() + static_cast<std::ptrdiff_t>(face * texels), texels, images[face].begin());
  }
  return images;
}

}  // namespace pb
