#include "raster/scene_resources.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>

#include "raster/inward_distance.h"
#include "scenes/dfg_table.h"

namespace pb {
namespace {

// What the vertex shader reads (raster/shaders/scene.vert).
struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
  glm::vec4 tangent;
  glm::vec4 uv;  // both sets
  glm::vec4 color;
  float uvPerMetre;
};

struct Attribute {
  GLint components;
  std::size_t offset;
};
constexpr std::array<Attribute, 6> kAttributes = {{{3, offsetof(Vertex, position)},
                                                   {3, offsetof(Vertex, normal)},
                                                   {4, offsetof(Vertex, tangent)},
                                                   {4, offsetof(Vertex, uv)},
                                                   {4, offsetof(Vertex, color)},
                                                   {1, offsetof(Vertex, uvPerMetre)}}};

template <class T>
T valueOr(const std::vector<T>& values, std::size_t i, const T& otherwise) {
  return values.empty() ? otherwise : values[i];
}

std::vector<Vertex> interleave(const Mesh& mesh) {
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec2 uv0 = valueOr(mesh.uvs[0], i, glm::vec2(0.0f));
    const glm::vec2 uv1 = valueOr(mesh.uvs[1], i, glm::vec2(0.0f));
    vertices.push_back({.position = mesh.positions[i],
                        .normal = mesh.normals[i],
                        .tangent = valueOr(mesh.tangents, i, glm::vec4(0.0f)),
                        .uv = {uv0.x, uv0.y, uv1.x, uv1.y},
                        .color = valueOr(mesh.colors, i, glm::vec4(1.0f)),
                        .uvPerMetre = valueOr(mesh.uvPerMetre, i, 0.0f)});
  }
  return vertices;
}

void describeVertices(const gl::Functions& gl, const GpuMesh& mesh) {
  const GLuint array = mesh.vertexArray.id();
  gl.VertexArrayVertexBuffer(array, 0, mesh.vertices.id(), 0, sizeof(Vertex));
  gl.VertexArrayElementBuffer(array, mesh.indices.id());
  for (GLuint location = 0; location < kAttributes.size(); ++location) {
    const Attribute& attribute = kAttributes[location];
    gl.EnableVertexArrayAttrib(array, location);
    gl.VertexArrayAttribFormat(array, location, attribute.components, GL_FLOAT, GL_FALSE,
                               static_cast<GLuint>(attribute.offset));
    gl.VertexArrayAttribBinding(array, location, 0);
  }
}

// The material's textures, -1 for none, in the order of the slots in MaterialConstants. Screens are numbered after the
// scene's textures.
std::array<int, kMaterialTextures> texturesOf(const Scene& scene, const Material& m) {
  const int emission = m.screen < 0 ? m.emissionTexture : static_cast<int>(scene.textures.size()) + m.screen;
  return {m.baseColorTexture, m.metallicRoughnessTexture, m.normalTexture, emission, m.occlusionTexture};
}

gl::Texture makeMaterialTexture(const gl::Functions& gl, int width, int height, int levels) {
  return gl::makeTexture(
      gl, {.target = GL_TEXTURE_2D, .format = GL_RGBA32F, .width = width, .height = height, .levels = levels});
}

void uploadLevels(const gl::Texture& texture, const std::vector<ImageRgba>& levels) {
  for (GLint level = 0; level < static_cast<GLint>(levels.size()); ++level) {
    const ImageRgba& texels = levels[static_cast<std::size_t>(level)];
    texture.gl().TextureSubImage2D(texture.id(), level, 0, 0, texels.width(), texels.height(), GL_RGBA, GL_FLOAT,
                                   texels.data());
  }
}

std::array<const shading::TextureSlot*, kMaterialTextures> slotsOf(const Material& m) {
  const shading::MaterialConstants& c = m.constants;
  return {&c.baseColorSlot, &c.metallicRoughnessSlot, &c.normalSlot, &c.emissionSlot, &c.occlusionSlot};
}

GLenum wrapMode(float wrap) {
  if (wrap == shading::kWrapClamp) return GL_CLAMP_TO_EDGE;
  return wrap == shading::kWrapMirror ? GL_MIRRORED_REPEAT : GL_REPEAT;
}

GLenum minFilter(float filter) {
  static constexpr std::array<GLenum, 6> kFilters = {GL_NEAREST,
                                                     GL_LINEAR,
                                                     GL_NEAREST_MIPMAP_NEAREST,
                                                     GL_LINEAR_MIPMAP_NEAREST,
                                                     GL_NEAREST_MIPMAP_LINEAR,
                                                     GL_LINEAR_MIPMAP_LINEAR};
  return kFilters[static_cast<std::size_t>(filter)];
}

}  // namespace

GpuMesh::GpuMesh(const gl::Functions& gl, std::shared_ptr<const Mesh> source_)
    : source(std::move(source_)),
      vertexArray(gl::makeVertexArray(gl)),
      vertices(gl, gl::bytesOf(interleave(*source))),
      indices(gl, gl::bytesOf(source->indices)),
      smoothingGroups(gl, gl::bytesOf(source->smoothingGroups)),
      indexCount(static_cast<GLsizei>(source->indices.size())) {
  describeVertices(gl, *this);
}

SceneResources::SceneResources(gl::Context& context, std::shared_ptr<const Scene> scene)
    : context_(context), gl_(context.functions()), scene_(std::move(scene)), constants_(context, 1) {
  uploadTextures();
  makeScreens();
  uploadMaterials(context);
  uploadEnvironment();
  context.check("uploading a scene's textures");
}

const GpuMesh& SceneResources::mesh(const std::shared_ptr<const Mesh>& mesh) {
  return meshes_.try_emplace(mesh.get(), gl_, mesh).first->second;
}

void SceneResources::addInwardDistances(const std::shared_ptr<const Mesh>& mesh) {
  constexpr GLuint kLocation = 6;  // after kAttributes
  constexpr GLuint kBinding = 1;
  GpuMesh& gpuMesh = meshes_.try_emplace(mesh.get(), gl_, mesh).first->second;
  if (gpuMesh.inwardDistances.id() != 0) return;
  gpuMesh.inwardDistances = gl::Buffer(gl_, gl::bytesOf(inwardDistances(*mesh)));
  const GLuint array = gpuMesh.vertexArray.id();
  gl_.VertexArrayVertexBuffer(array, kBinding, gpuMesh.inwardDistances.id(), 0, sizeof(float));
  gl_.EnableVertexArrayAttrib(array, kLocation);
  gl_.VertexArrayAttribFormat(array, kLocation, 1, GL_FLOAT, GL_FALSE, 0);
  gl_.VertexArrayAttribBinding(array, kLocation, kBinding);
}

SurfaceVariant SceneResources::variantOf(int material, const Mesh& mesh, TextureFilter filter) const {
  const Material& m = scene_->materials[static_cast<std::size_t>(material)];
  SurfaceVariant variant;
  variant.kind = m.constants.kind.x;
  if (hasRoughLobe(m)) variant.lobe = m.metallicRoughnessTexture < 0 ? Lobe::rough : Lobe::mixed;
  variant.filter = filter;
  variant.coverage = m.constants.alpha.x;
  variant.attributes = !mesh.colors.empty();
  const auto textures = texturesOf(*scene_, m);
  const auto slots = slotsOf(m);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (textures[i] < 0) continue;
    const glm::vec4& s = slots[i]->sampler_;
    variant.textures[i] = SamplerSettings{s.x, s.y, s.z, s.w};
    variant.attributes = true;
  }
  return variant;
}

void SceneResources::bindScene() const {
  constants_.bind(gpu::kSceneBlock, 0);
  gl_.BindTextureUnit(gpu::kEnvironmentUnit, environmentFaces_.id());
  gl_.BindTextureUnit(gpu::kEnvironmentCubeUnit, environmentCube_.id());
}

void SceneResources::bindMaterial(int material) const {
  const auto m = static_cast<std::size_t>(material);
  materials_.bind(gpu::kMaterialBlock, m);
  for (const Binding& binding : materialBindings_[m]) {
    gl_.BindTextureUnit(binding.unit, binding.texture);
    gl_.BindSampler(binding.unit, binding.sampler);
  }
}

void SceneResources::uploadTextures() {
  for (const Texture& source : scene_->textures) {
    const ImageRgba& level0 = source.levels.front();
    textures_.push_back(
        makeMaterialTexture(gl_, level0.width(), level0.height(), static_cast<int>(source.levels.size())));
    uploadLevels(textures_.back(), source.levels);
  }
}

void SceneResources::makeScreens() {
  for (const Screen& screen : scene_->screens) {
    const int levels = std::bit_width(static_cast<unsigned>(std::max(screen.widthPx, screen.heightPx)));
    textures_.push_back(makeMaterialTexture(gl_, screen.widthPx, screen.heightPx, levels));
  }
  shownOnScreens_.resize(scene_->screens.size());
}

// Compared by content: sequences that share a device show the scene at different times.
void SceneResources::showScreens(const std::vector<Texture>& screens) {
  for (std::size_t i = 0; i < screens.size(); ++i) {
    const ImageRgba& level0 = screens[i].levels.front();
    if (shownOnScreens_[i] == level0) continue;
    uploadLevels(textures_[scene_->textures.size() + i], screens[i].levels);
    shownOnScreens_[i] = level0;
  }
}

void SceneResources::uploadMaterials(gl::Context& context) {
  materials_ = UniformSlots<shading::MaterialConstants>(context, scene_->materials.size());
  for (std::size_t m = 0; m < scene_->materials.size(); ++m) {
    const Material& material = scene_->materials[m];
    materials_.set(m, material.constants);
    const auto textures = texturesOf(*scene_, material);
    const auto slots = slotsOf(material);
    std::vector<Binding>& bindings = materialBindings_.emplace_back();
    for (std::size_t i = 0; i < textures.size(); ++i)
      if (textures[i] >= 0)
        bindings.push_back({static_cast<GLuint>(gpu::kMaterialUnit) + static_cast<GLuint>(i),
                            textures_[static_cast<std::size_t>(textures[i])].id(), samplerFor(slots[i]->sampler_)});
  }
  materials_.upload();
}

void SceneResources::uploadEnvironment() {
  const Environment& environment = scene_->environment;
  constants_.set(0, {environment.sky, environment.ambient});
  constants_.upload();
  const int size = environment.faces.front().width();
  environmentFaces_ = gl::makeTexture(
      gl_, {.target = GL_TEXTURE_2D_ARRAY, .format = GL_RGBA32F, .width = size, .height = size, .layers = 6});
  for (GLint face = 0; face < 6; ++face)
    gl_.TextureSubImage3D(environmentFaces_.id(), 0, 0, 0, face, size, size, 1, GL_RGBA, GL_FLOAT,
                          environment.faces[static_cast<std::size_t>(face)].data());
  environmentCube_ = gl::makeCubeView(environmentFaces_, GL_RGBA32F);
}

int SceneResources::filterEnvironment(ProbeFilter filter, Programs& programs) {
  if (filter == ProbeFilter::none || std::ranges::none_of(scene_->materials, hasRoughLobe)) return 0;
  FilteredEnvironment& filtered = filtered_[filter];
  if (filtered.resolution == 0) {
    bindScene();
    filtered = pb::filterEnvironment(context_, programs, scene_->environment, filter);
  }
  return filtered.resolution;
}

void SceneResources::bindReflection(const Technique& technique) {
  gl_.BindTextureUnit(gpu::kDfgUnit, dfgTableOf(technique.geometryTerm).id());
  if (const auto found = filtered_.find(technique.filter); found != filtered_.end())
    gl_.BindTextureUnit(gpu::kEnvironmentLevelsUnit, found->second.cube.id());
}

const gl::Texture& SceneResources::dfgTableOf(GeometryTerm term) {
  gl::Texture& table = dfgTables_[static_cast<std::size_t>(term)];
  if (table.id() != 0) return table;
  const ImageRgba& texels = dfgTable(static_cast<float>(term)).levels.front();
  table = gl::makeTexture(
      gl_, {.target = GL_TEXTURE_2D, .format = GL_RGBA32F, .width = texels.width(), .height = texels.height()});
  gl_.TextureSubImage2D(table.id(), 0, 0, 0, texels.width(), texels.height(), GL_RGBA, GL_FLOAT, texels.data());
  return table;
}

GLuint SceneResources::samplerFor(const glm::vec4& settings) {
  const auto [found, isNew] = samplers_.try_emplace({settings.x, settings.y, settings.z, settings.w});
  if (isNew)
    found->second = gl::makeSampler(gl_, settings.z == shading::kFilterNearest ? GL_NEAREST : GL_LINEAR,
                                    minFilter(settings.w), wrapMode(settings.x), wrapMode(settings.y));
  return found->second.id();
}

}  // namespace pb
