#include "raster/scene_resources.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "raster/plain_material.h"
#include "scenes/dfg_table.h"

namespace pb {
namespace {

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

SceneResources::SceneResources(gl::Context& context, std::shared_ptr<const Scene> scene)
    : context_(context),
      gl_(context.functions()),
      scene_(std::move(scene)),
      constants_(context, 1 + scene_->environmentChanges.size()),
      environments_(1 + scene_->environmentChanges.size()) {
  uploadTextures();
  makeScreens();
  uploadMaterials(context);
  for (std::size_t i = 0; i < environments_.size(); ++i)
    constants_.set(i, {scene_->environmentAt(i).sky, scene_->environmentAt(i).ambient});
  constants_.upload();
  showEnvironment(0);
  context.check("uploading a scene's textures");
}

const GpuMesh& SceneResources::mesh(std::size_t instance, const std::shared_ptr<const Mesh>& mesh,
                                    const MeshNeeds& needs) {
  GpuMesh& gpuMesh = mesh->isDeformed ? deformed_.try_emplace(instance, gl_, mesh).first->second
                                      : meshes_.try_emplace(mesh.get(), gl_, mesh).first->second;
  // Compared by content: sequences that share a device show the scene at different times.
  const bool hasTopology = gpuMesh.source->positions.size() == mesh->positions.size() &&
                           gpuMesh.source->indices.size() == mesh->indices.size();
  if (!hasTopology)
    gpuMesh = GpuMesh(gl_, mesh);
  else if (gpuMesh.source->contentHash != mesh->contentHash)
    gpuMesh.show(mesh);
  if (needs.inwardDistances) gpuMesh.addInwardDistances(gl_);
  if (needs.share < 1.0f && !gpuMesh.simplified.contains(needs.share)) {
    const bool restsAlike = needs.rest != nullptr && needs.rest->indices == mesh->indices &&
                            needs.rest->positions.size() == mesh->positions.size();
    gpuMesh.simplify(gl_, restsAlike ? *needs.rest : *mesh, needs.share);
  }
  if (needs.planes) gpuMesh.addPlanes(gl_, 1.0f);
  if (needs.planes && needs.share < 1.0f) gpuMesh.addPlanes(gl_, needs.share);
  return gpuMesh;
}

SurfaceVariant SceneResources::variantOf(int material, const Mesh& mesh, TextureFilter filter) const {
  const Material& m = scene_->materials[static_cast<std::size_t>(material)];
  SurfaceVariant variant;
  variant.kind = m.constants.kind.x;
  if (hasRoughLobe(m)) variant.lobe = m.metallicRoughnessTexture < 0 ? Lobe::rough : Lobe::mixed;
  variant.filter = filter;
  variant.coverage = m.constants.alpha.x;
  variant.emits = glm::vec3(m.constants.emission) != glm::vec3(0.0f);
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
  const GpuEnvironment& environment = environments_[shownEnvironment_];
  constants_.bind(gpu::kSceneBlock, shownEnvironment_);
  gl_.BindTextureUnit(gpu::kEnvironmentUnit, environment.faces.id());
  gl_.BindTextureUnit(gpu::kEnvironmentCubeUnit, environment.cube.id());
}

void SceneResources::bindMaterial(int material) const {
  materials_.bind(gpu::kMaterialBlock, static_cast<std::size_t>(material));
  bindTextures(material);
}

void SceneResources::bindPlainMaterial(int material) const {
  plainMaterials_.bind(gpu::kMaterialBlock, static_cast<std::size_t>(material));
  bindTextures(material);
}

void SceneResources::bindTextures(int material) const {
  for (const Binding& binding : materialBindings_[static_cast<std::size_t>(material)]) {
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

void SceneResources::showPlainMaterials(const std::vector<Texture>& screens) {
  if (plainMaterials_.size() == 0)
    plainMaterials_ = UniformSlots<shading::MaterialConstants>(context_, scene_->materials.size());
  for (std::size_t m = 0; m < scene_->materials.size(); ++m)
    plainMaterials_.set(m, plainConstants(*scene_, screens, scene_->materials[m]));
  plainMaterials_.upload();
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

void SceneResources::showEnvironment(std::size_t index) {
  shownEnvironment_ = index;
  if (environments_[index].faces.id() == 0) uploadEnvironment(index);
}

void SceneResources::uploadEnvironment(std::size_t index) {
  const std::vector<ImageRgba>& faces = scene_->environmentAt(index).faces;
  GpuEnvironment& environment = environments_[index];
  const int size = faces.front().width();
  environment.faces = gl::makeTexture(
      gl_, {.target = GL_TEXTURE_2D_ARRAY, .format = GL_RGBA32F, .width = size, .height = size, .layers = 6});
  for (GLint face = 0; face < 6; ++face)
    gl_.TextureSubImage3D(environment.faces.id(), 0, 0, 0, face, size, size, 1, GL_RGBA, GL_FLOAT,
                          faces[static_cast<std::size_t>(face)].data());
  environment.cube = gl::makeCubeView(environment.faces, GL_RGBA32F);
}

int SceneResources::filterEnvironment(ProbeFilter filter, Programs& programs) {
  if (filter == ProbeFilter::none || std::ranges::none_of(scene_->materials, hasRoughLobe)) return 0;
  FilteredEnvironment& filtered = environments_[shownEnvironment_].filtered[filter];
  if (filtered.resolution == 0) {
    bindScene();
    filtered = pb::filterEnvironment(context_, programs, scene_->environmentAt(shownEnvironment_), filter);
  }
  return filtered.resolution;
}

void SceneResources::bindReflection(const Technique& technique) {
  gl_.BindTextureUnit(gpu::kDfgUnit, dfgTableOf(technique.geometryTerm).id());
  const std::map<ProbeFilter, FilteredEnvironment>& filtered = environments_[shownEnvironment_].filtered;
  if (const auto found = filtered.find(technique.filter); found != filtered.end())
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
