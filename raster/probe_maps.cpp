#include "raster/probe_maps.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "raster/probe_owners.h"

namespace pb {
namespace {

// llvmpipe 22 waits for all that is drawn whenever a texture is bound that one of its last scenes drew to: once a face,
// as maps are drawn to and looked up in turn. Drawn apart they are waited for once a probe, by the copy. Larger faces
// have enough tiles for all threads: frames with maps of 256 texels take as long either way (docs/performance.md).
constexpr int kLargestApart = 128;

}  // namespace

ProbeMaps::ProbeMaps(gl::Context& context, Programs& programs, const Settings& settings)
    : context_(context),
      gl_(context.functions()),
      programs_(programs),
      settings_(settings),
      format_(texelFormat(settings.format)),
      depth_(gl::makeTexture(gl_, {.target = GL_TEXTURE_2D,
                                   .format = GL_DEPTH_COMPONENT32F,
                                   .width = settings.largest,
                                   .height = settings.largest})) {
  for (const int resolution : settings.resolutions) maps_.push_back(makeMap(resolution));
  context.check("allocating cube maps");
  framebuffer_ = gl::makeLayerFramebuffer(gl_, maps_.front().captured(), depth_);
}

ProbeMaps::Tools& ProbeMaps::toolsFor(int resolution) {
  const auto [found, isNew] = tools_.try_emplace(resolution);
  Tools& tools = found->second;
  if (!isNew) return tools;
  tools.levels = filteredLevels(settings_.filter, resolution);
  if (tools.levels > 0) tools.filter.emplace(context_, programs_, settings_.filter, format_, resolution);
  if (drawsApart(resolution))
    tools.apart = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                        .format = format_.captured,
                                        .width = resolution,
                                        .height = resolution,
                                        .layers = settings_.views});
  if (isConverted(settings_.format, settings_.storage))
    tools.conversion.emplace(context_, programs_, settings_.format, settings_.storage, resolution, settings_.seamless);
  return tools;
}

// Maps with a back are drawn to what no lookup reads anyway. Distances are in depth buffers of their own, and a single
// view is waited for once.
bool ProbeMaps::drawsApart(int resolution) const {
  return settings_.capturesApart && !hasBacks() && !settings_.keepsDistances && settings_.views == 6 &&
         resolution <= kLargestApart;
}

ProbeMaps::Map ProbeMaps::makeMap(int resolution) {
  Map map;
  map.resolution = resolution;
  addShown(map, toolsFor(resolution).levels);
  if (hasBacks()) {
    map.back = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                     .format = format_.captured,
                                     .width = resolution,
                                     .height = resolution,
                                     .layers = settings_.views});
    if (settings_.storage != Storage::cube) map.backCube = gl::makeCubeView(map.back, format_.captured);
  }
  if (settings_.keepsDistances) addDepths(map);
  return map;
}

void ProbeMaps::addShown(Map& map, int levels) const {
  const MapSquares squares = mapSquares(settings_.storage, map.resolution);
  const int layers = settings_.views == 1 ? 1 : squares.count;
  map.shownLayers = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                          .format = format_.shown,
                                          .width = squares.edge,
                                          .height = squares.edge,
                                          .layers = layers,
                                          .levels = levels + 1});
  map.shownImage = makeImageView(map.shownLayers, format_, levels + 1, layers);
  GLenum target = GL_TEXTURE_CUBE_MAP;
  if (settings_.views == 1) target = GL_TEXTURE_2D;
  if (settings_.storage != Storage::cube) target = GL_TEXTURE_2D_ARRAY;
  map.shown = gl::makeView(map.shownLayers, {target, format_.shown, levels + 1, layers});
}

void ProbeMaps::addDepths(Map& map) const {
  constexpr float kFarthest = 0.0f;
  const auto makeDepths = [&] {
    gl::Texture depths = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                               .format = GL_DEPTH_COMPONENT32F,
                                               .width = map.resolution,
                                               .height = map.resolution,
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
  if (settings_.keepsDistances) gl_.BindTextureUnit(static_cast<GLuint>(depthUnit), mapOf(probe).shownDepths.id());
}

const gl::Texture& ProbeMaps::drawn(int probe) const {
  const gl::Texture& apart = tools_.at(mapOf(probe).resolution).apart;
  return apart.id() != 0 ? apart : captured(probe);
}

// Captures of another probe take the place of those drawn before.
void ProbeMaps::beginFace(const ProbeFace& face) {
  if (face.probe != drawnProbe_) copyDrawn();
  drawnProbe_ = face.probe;
  if (&drawn(face.probe) != &captured(face.probe)) drawnFaces_ |= 1u << face.face;
}

void ProbeMaps::copyDrawn() {
  for (int face = 0; face < 6; ++face)
    if ((drawnFaces_ >> face & 1u) != 0)
      copyFace(drawn(drawnProbe_), captured(drawnProbe_), face, mapOf(drawnProbe_).resolution);
  drawnFaces_ = 0;
}

RenderTarget ProbeMaps::target(const ProbeFace& face) {
  beginFace(face);
  gl::setColorLayer(framebuffer_, drawn(face.probe), face.face);
  if (settings_.keepsDistances) gl::setDepthLayer(framebuffer_, mapOf(face.probe).capturedDepths(), face.face);
  return {framebuffer_.id(), mapOf(face.probe).resolution, mapOf(face.probe).resolution};
}

void ProbeMaps::setFurtherColors(std::span<const gl::Texture* const> colors) {
  recordingFramebuffer_ = gl::makeLayerFramebuffer(gl_, maps_.front().captured(), depth_);
  std::vector<GLenum> drawn = {GL_COLOR_ATTACHMENT0};
  for (const gl::Texture* color : colors) {
    drawn.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(drawn.size()));
    gl_.NamedFramebufferTexture(recordingFramebuffer_.id(), drawn.back(), color->id(), 0);
  }
  furtherColors_ = static_cast<GLenum>(colors.size());
  drawn.push_back(GL_COLOR_ATTACHMENT0 + furtherColors_ + 1);
  gl_.NamedFramebufferDrawBuffers(recordingFramebuffer_.id(), static_cast<GLsizei>(drawn.size()), drawn.data());
}

RenderTarget ProbeMaps::recordingTarget(const ProbeFace& face, const gl::Texture* lastColor) {
  beginFace(face);
  gl::setColorLayer(recordingFramebuffer_, drawn(face.probe), face.face);
  const GLenum attachment = GL_COLOR_ATTACHMENT0 + furtherColors_ + 1;
  gl_.NamedFramebufferTextureLayer(recordingFramebuffer_.id(), attachment, lastColor == nullptr ? 0 : lastColor->id(),
                                   0, lastColor == nullptr ? 0 : face.face);
  return {recordingFramebuffer_.id(), mapOf(face.probe).resolution, mapOf(face.probe).resolution};
}

void ProbeMaps::reorder(const std::vector<int>& before, const std::vector<int>& resolutions) {
  std::vector<Map> maps = std::exchange(maps_, {});
  for (std::size_t probe = 0; probe < before.size(); ++probe)
    maps_.push_back(before[probe] == kNewProbe ? makeMap(resolutions[probe])
                                               : std::move(maps[static_cast<std::size_t>(before[probe])]));
  context_.check("allocating cube maps");
}

void ProbeMaps::resize(int probe, int resolution) {
  const Map before = std::exchange(mapOf(probe), makeMap(resolution));
  const gl::Framebuffer source = gl::makeLayerFramebuffer(gl_, before.captured(), depth_);
  std::vector<ProbeFace> scaled;
  for (int view = 0; view < settings_.views; ++view) {
    gl::setColorLayer(source, before.captured(), view);
    const RenderTarget to = target({probe, view});
    gl_.BlitNamedFramebuffer(source.id(), to.framebuffer, 0, 0, before.resolution, before.resolution, 0, 0, to.widthPx,
                             to.heightPx, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    scaled.push_back({probe, view});
  }
  publish(scaled);
  context_.check("allocating cube maps");
}

void ProbeMaps::write(int probe, const std::array<Image, 6>& faces, const std::array<Plane, 6>& distances,
                      float zNear) {
  const Map& map = mapOf(probe);
  std::vector<ProbeFace> written;
  for (int face = 0; face < 6; ++face) {
    writeRadiances(map, face, faces[static_cast<std::size_t>(face)]);
    if (settings_.keepsDistances) writeDistances(map, face, distances[static_cast<std::size_t>(face)], zNear);
    written.push_back({probe, face});
  }
  publish(written);
  context_.check("writing a cube map");
}

void ProbeMaps::writeRadiances(const Map& map, int face, Image radiances) const {
  for (glm::vec3& texel : radiances) {
    texel = glm::min(texel, glm::vec3(format_.largestRadiance));
    if (settings_.format == ProbeFormat::rgba8Srgb)  // written as it is stored
      texel = {shading::srgbEncode(texel.x), shading::srgbEncode(texel.y), shading::srgbEncode(texel.z)};
  }
  gl_.TextureSubImage3D(map.captured().id(), 0, 0, 0, face, map.resolution, map.resolution, 1, GL_RGB, GL_FLOAT,
                        radiances.data());
}

void ProbeMaps::writeDistances(const Map& map, int face, Plane distances, float zNear) const {
  for (float& distance : distances) distance = zNear / distance;
  gl_.TextureSubImage3D(map.capturedDepths().id(), 0, 0, 0, face, map.resolution, map.resolution, 1, GL_DEPTH_COMPONENT,
                        GL_FLOAT, distances.data());
}

std::array<Plane, 6> ProbeMaps::readDistances(int probe, float zNear) const {
  const Map& map = mapOf(probe);
  std::array<Plane, 6> planes;
  for (std::size_t face = 0; face < planes.size(); ++face) {
    Plane& plane = planes[face] = Plane(map.resolution, map.resolution);
    gl_.GetTextureSubImage(map.shownDepthLayers.id(), 0, 0, 0, static_cast<GLint>(face), map.resolution, map.resolution,
                           1, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(plane.size() * sizeof(float)),
                           plane.data());
    for (float& depth : plane) depth = zNear / depth;  // 0 becomes infinity
  }
  return planes;
}

std::int64_t ProbeMaps::publish(const std::vector<ProbeFace>& captured) {
  copyDrawn();
  std::vector<FaceSet> changed(maps_.size(), 0);
  for (const ProbeFace& face : captured) changed[static_cast<std::size_t>(face.probe)] |= 1u << face.face;
  std::int64_t converted = 0;
  for (std::size_t probe = 0; probe < maps_.size(); ++probe) {
    Map& map = maps_[probe];
    if (changed[probe] == 0) continue;
    map.unfiltered |= changed[probe];
    for (int face = 0; face < 6; ++face)
      if (map.back.id() != 0 && (changed[probe] >> face & 1u) != 0) copyToShown(map, face);
    if (const auto& conversion = toolsFor(map.resolution).conversion)
      converted += conversion->run(map.backCube.id() != 0 ? map.backCube : map.back, map.shownLayers, map.shownImage,
                                   changed[probe]);
  }
  // Single-buffered captures are read in the texture that they were drawn to.
  if (maps_.front().back.id() == 0) gl_.TextureBarrier();
  return converted;
}

// What is not converted.
void ProbeMaps::copyToShown(const Map& map, int face) const {
  if (!isConverted(settings_.format, settings_.storage)) copyFace(map.back, map.shownLayers, face, map.resolution);
  if (settings_.keepsDistances) copyFace(map.backDepths, map.shownDepthLayers, face, map.resolution);
}

void ProbeMaps::copyFace(const gl::Texture& from, const gl::Texture& to, int face, int resolution) const {
  gl_.CopyImageSubData(from.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, face, to.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, face,
                       resolution, resolution, 1);
}

bool ProbeMaps::isStale(const std::vector<bool>& wanted) const {
  if (settings_.filter == ProbeFilter::none) return false;
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
    if (auto& filter = toolsFor(map.resolution).filter)
      texels += filter->run(map.shownLayers, map.shownImage, map.unfiltered);
    map.unfiltered = 0;
  }
  return texels;
}

std::array<Image, 6> ProbeMaps::read(int probe, int level) const {
  const Map& map = mapOf(probe);
  const gl::Texture& layers = settings_.storage == Storage::cube ? map.shownLayers : map.back;
  const int size = std::max(map.resolution >> level, 1);
  const std::size_t texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const auto views = static_cast<std::size_t>(settings_.views);
  std::vector<glm::vec3> faces(views * texels);
  gl_.GetTextureSubImage(layers.id(), level, 0, 0, 0, size, size, settings_.views, GL_RGB, GL_FLOAT,
                         static_cast<GLsizei>(faces.size() * sizeof(glm::vec3)), faces.data());
  if (settings_.format == ProbeFormat::rgba8Srgb)  // read as it is stored
    for (glm::vec3& texel : faces)
      texel = {shading::srgbDecode(texel.x), shading::srgbDecode(texel.y), shading::srgbDecode(texel.z)};
  std::array<Image, 6> images;
  for (std::size_t face = 0; face < views; ++face) {
    images[face] = Image(size, size);
    std::copy_n(faces.begin() + static_cast<std::ptrdiff_t>(face * texels), texels, images[face].begin());
  }
  return images;
}

}  // namespace pb
