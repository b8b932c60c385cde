#include "raster/probe_maps.h"

#include <algorithm>

namespace pb {

ProbeMaps::ProbeMaps(gl::Context& context, Programs& programs, int resolution, int probes, int views,
                     bool doubleBuffered, ProbeFilter filter, bool keepsDistances)
    : gl_(context.functions()),
      resolution_(resolution),
      views_(views),
      levels_(filteredLevels(filter, resolution)),
      keepsDistances_(keepsDistances),
      depth_(gl::makeTexture(
          gl_, {.target = GL_TEXTURE_2D, .format = GL_DEPTH_COMPONENT32F, .width = resolution, .height = resolution})) {
  for (int probe = 0; probe < probes; ++probe) maps_.push_back(makeMap(doubleBuffered));
  if (levels_ > 0) filter_.emplace(context, programs, filter, GL_RGBA16F, resolution);
  context.check("allocating cube maps");
  framebuffer_ = gl::makeLayerFramebuffer(gl_, maps_.front().captured(), depth_);
}

ProbeMaps::Map ProbeMaps::makeMap(bool doubleBuffered) const {
  const auto makeFaces = [&](int levels) {
    return gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                 .format = GL_RGBA16F,
                                 .width = resolution_,
                                 .height = resolution_,
                                 .layers = views_,
                                 .levels = levels});
  };
  Map map;
  map.shownLayers = makeFaces(levels_ + 1);
  map.shown = gl::makeView(map.shownLayers,
                           {views_ == 6 ? static_cast<GLenum>(GL_TEXTURE_CUBE_MAP) : static_cast<GLenum>(GL_TEXTURE_2D),
                            GL_RGBA16F, levels_ + 1, views_});
  if (doubleBuffered) map.back = makeFaces(1);
  if (keepsDistances_) addDepths(map);
  return map;
}

void ProbeMaps::addDepths(Map& map) const {
  constexpr float kFarthest = 0.0f;
  const auto makeDepths = [&] {
    gl::Texture depths = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                               .format = GL_DEPTH_COMPONENT32F,
                                               .width = resolution_,
                                               .height = resolution_,
                                               .layers = 6});
    gl_.ClearTexImage(depths.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, &kFarthest);
    return depths;
  };
  map.shownDepthLayers = makeDepths();
  map.shownDepths = gl::makeCubeView(map.shownDepthLayers, GL_DEPTH_COMPONENT32F);
  if (map.back.id() != 0) map.backDepths = makeDepths();
}

void ProbeMaps::bind(int probe, int unit, int depthUnit) const {
  gl_.BindTextureUnit(static_cast<GLuint>(unit), mapOf(probe).shown.id());
  if (keepsDistances_) gl_.BindTextureUnit(static_cast<GLuint>(depthUnit), mapOf(probe).shownDepths.id());
}

RenderTarget ProbeMaps::target(const ProbeFace& face) {
  gl::setColorLayer(framebuffer_, mapOf(face.probe).captured(), face.face);
  if (keepsDistances_) gl::setDepthLayer(framebuffer_, mapOf(face.probe).capturedDepths(), face.face);
  return {framebuffer_.id(), resolution_, resolution_};
}

void ProbeMaps::publish(const std::vector<ProbeFace>& captured) {
  bool isDoubleBuffered = false;
  for (const ProbeFace& face : captured) {
    Map& map = mapOf(face.probe);
    map.unfiltered |= 1u << face.face;
    if (map.back.id() == 0) continue;
    isDoubleBuffered = true;
    gl_.CopyImageSubData(map.back.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, face.face, map.shownLayers.id(),
                         GL_TEXTURE_2D_ARRAY, 0, 0, 0, face.face, resolution_, resolution_, 1);
    if (keepsDistances_)
      gl_.CopyImageSubData(map.backDepths.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, face.face, map.shownDepthLayers.id(),
                           GL_TEXTURE_2D_ARRAY, 0, 0, 0, face.face, resolution_, resolution_, 1);
  }
  // Single-buffered captures are read in the texture that they were drawn to.
  if (!isDoubleBuffered) gl_.TextureBarrier();
}

bool ProbeMaps::isStale(const std::vector<bool>& wanted) const {
  if (!filter_) return false;
  for (std::size_t probe = 0; probe < maps_.size(); ++probe)
    if (wanted[probe] && maps_[probe].unfiltered != 0) return true;
  return false;
}

std::int64_t ProbeMaps::filter(const std::vector<bool>& wanted) {
  if (!isStale(wanted)) return 0;
  std::int64_t texels = 0;
  for (std::size_t probe = 0; probe < maps_.size(); ++probe) {
    Map& map = maps_[probe];
    if (!wanted[probe] || map.unfiltered == 0) continue;
    texels += filter_->run(map.shownLayers, 0, map.unfiltered);
    map.unfiltered = 0;
  }
  return texels;
}

std::array<Image, 6> ProbeMaps::read(int probe, int level) const {
  const int size = std::max(resolution_ >> level, 1);
  const std::size_t texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const auto views = static_cast<std::size_t>(views_);
  std::vector<glm::vec3> faces(views * texels);
  gl_.GetTextureSubImage(mapOf(probe).shownLayers.id(), level, 0, 0, 0, size, size, views_, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(faces.size() * sizeof(glm::vec3)), faces.data());
  std::array<Image, 6> images;
  for (std::size_t face = 0; face < views; ++face) {
    images[face] = Image(size, size);
    std::copy_n(faces.begin() + static_cast<std::ptrdiff_t>(face * texels), texels, images[face].begin());
  }
  return images;
}

}  // namespace pb
