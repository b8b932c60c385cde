#include "raster/probe_maps.h"

namespace pb {
namespace {

gl::Texture makeCubes(const gl::Functions& gl, int resolution, int probes) {
  return gl::makeTexture(gl, {.target = GL_TEXTURE_CUBE_MAP_ARRAY,
                              .format = GL_RGBA16F,
                              .width = resolution,
                              .height = resolution,
                              .layers = 6 * probes});
}

GLint layerOf(const ProbeFace& face) { return 6 * face.probe + face.face; }

}  // namespace

ProbeMaps::ProbeMaps(gl::Context& context, int resolution, int probes, bool doubleBuffered)
    : gl_(context.functions()),
      resolution_(resolution),
      shown_(makeCubes(gl_, resolution, probes)),
      back_(doubleBuffered ? makeCubes(gl_, resolution, probes) : gl::Texture()),
      depth_(gl::makeTexture(
          gl_, {.target = GL_TEXTURE_2D, .format = GL_DEPTH_COMPONENT32F, .width = resolution, .height = resolution})) {
  context.check("allocating cube maps");
  framebuffer_ = gl::makeLayerFramebuffer(gl_, captured(), depth_);
}

void ProbeMaps::bind() const { gl_.BindTextureUnit(gpu::kProbeUnit, shown_.id()); }

RenderTarget ProbeMaps::target(const ProbeFace& face) {
  gl::setColorLayer(framebuffer_, captured(), layerOf(face));
  return {framebuffer_.id(), resolution_, resolution_};
}

void ProbeMaps::publish(const std::vector<ProbeFace>& captured) {
  // Single-buffered captures are read in the texture that they were drawn to.
  if (back_.id() == 0) return gl_.TextureBarrier();
  for (const ProbeFace& face : captured)
    gl_.CopyImageSubData(back_.id(), GL_TEXTURE_CUBE_MAP_ARRAY, 0, 0, 0, layerOf(face), shown_.id(),
                         GL_TEXTURE_CUBE_MAP_ARRAY, 0, 0, 0, layerOf(face), resolution_, resolution_, 1);
}

std::array<Image, 6> ProbeMaps::read(int probe) const {
  const std::size_t texels = static_cast<std::size_t>(resolution_) * static_cast<std::size_t>(resolution_);
  std::vector<glm::vec3> faces(6 * texels);
  gl_.GetTextureSubImage(shown_.id(), 0, 0, 0, layerOf({probe, 0}), resolution_, resolution_, 6, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(faces.size() * sizeof(glm::vec3)), faces.data());
  std::array<Image, 6> images;
  for (std::size_t face = 0; face < images.size(); ++face) {
    images[face] = Image(resolution_, resolution_);
    std::copy_n(faces.begin() + static_cast<std::ptrdiff_t>(face * texels), texels, images[face].begin());
  }
  return images;
}

}  // namespace pb
