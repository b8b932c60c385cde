#include "raster/programs.h"

#include <fmt/format.h>

#include <array>

#include "raster/shaders/background.frag.h"
#include "raster/shaders/background.vert.h"
#include "raster/shaders/compose_layers.frag.h"
#include "raster/shaders/ids.frag.h"
#include "raster/shaders/scene.frag.h"
#include "raster/shaders/scene.vert.h"

namespace pb {
namespace {

constexpr std::array<const char*, kMaterialTextures> kTextureDefines = {
    "BASE_COLOR_TEXTURE", "METALLIC_ROUGHNESS_TEXTURE", "NORMAL_TEXTURE", "EMISSION_TEXTURE", "OCCLUSION_TEXTURE"};

std::string define(const std::string& name, const std::string& value = "") {
  return "#define " + name + " " + value + "\n";
}

std::string glslOf(const SamplerSettings& s) {
  return fmt::format("vec4({:.1f}, {:.1f}, {:.1f}, {:.1f})", s.wrapU, s.wrapV, s.magFilter, s.minFilter);
}

std::string coverageDefine(float coverage) {
  if (coverage == shading::kAlphaMask) return define("ALPHA_MASK");
  return coverage == shading::kAlphaBlend ? define("ALPHA_BLEND") : "";
}

std::string definesOf(const SurfaceVariant& variant) {
  std::string defines = define("SURFACE_KIND", fmt::format("{:.1f}", variant.kind)) + coverageDefine(variant.coverage);
  if (variant.attributes) defines += define("ATTRIBUTES");
  if (variant.filter == TextureFilter::hardware) defines += define("TEXTURES_HARDWARE");
  for (std::size_t i = 0; i < kTextureDefines.size(); ++i)
    if (variant.textures[i]) defines += define(kTextureDefines[i], glslOf(*variant.textures[i]));
  return defines;
}

std::string definesOf(EnvironmentSource source) {
  std::string defines;
  if (source != EnvironmentSource::gradient) defines += define("ENVIRONMENT_FACES");
  if (source == EnvironmentSource::facesHardware) defines += define("ENVIRONMENT_HARDWARE");
  return defines;
}

// The #version line has to stay the first.
std::string withDefines(const std::string& shader, const std::string& defines) {
  const std::size_t secondLine = shader.find('\n') + 1;
  return shader.substr(0, secondLine) + defines + shader.substr(secondLine);
}

}  // namespace

EnvironmentSource environmentSource(const Environment& environment, TextureFilter filter) {
  if (environment.sky.toGlow.w <= 0.5f) return EnvironmentSource::gradient;
  return filter == TextureFilter::hardware ? EnvironmentSource::facesHardware : EnvironmentSource::faces;
}

std::string techniqueDefines(const Technique& technique) {
  const glm::vec4 law = fresnelLaw(technique.fresnel);
  return define("FRESNEL_LAW",
                fmt::format("vec4({:#.9g}f, {:#.9g}f, {:#.9g}f, {:#.9g}f)", law.x, law.y, law.z, law.w)) +
         define("GEOMETRY_TERM", fmt::format("{:.1f}", static_cast<double>(technique.geometryTerm)));
}

GLuint Programs::surfaceShowingProbe(const SurfaceVariant& variant, const std::string& techniqueDefines) {
  return find(shaders::kSceneVert, shaders::kSceneFrag, "scene",
              definesOf(variant) + techniqueDefines + define("PROBE_LOOKUP"));
}

GLuint Programs::surfaceShowingEnvironment(const SurfaceVariant& variant, EnvironmentSource source,
                                           const std::string& techniqueDefines) {
  return find(shaders::kSceneVert, shaders::kSceneFrag, "scene",
              definesOf(variant) + techniqueDefines + definesOf(source));
}

GLuint Programs::background(EnvironmentSource source) {
  return find(shaders::kBackgroundVert, shaders::kBackgroundFrag, "background", definesOf(source));
}

// Ids follow the exact filter's choice of texels whatever the filter.
GLuint Programs::ids(const SurfaceVariant& variant) {
  SurfaceVariant geometry;
  geometry.attributes = variant.attributes;
  geometry.coverage = variant.coverage;
  geometry.textures[0] = variant.textures[0];
  return find(shaders::kSceneVert, shaders::kIdsFrag, "ids", definesOf(geometry));
}

GLuint Programs::composeLayers() {
  return find(shaders::kBackgroundVert, shaders::kComposeLayersFrag, "compose_layers", "");
}

GLuint Programs::find(const char* vertexShader, const char* fragmentShader, const std::string& name,
                      const std::string& defines) {
  std::unique_ptr<gl::Program>& program = programs_[name + "\n" + defines];
  if (!program)
    program = std::make_unique<gl::Program>(
        gl_, std::vector<gl::ShaderSource>{
                 {GL_VERTEX_SHADER, "raster/shaders/" + name + ".vert", withDefines(vertexShader, defines)},
                 {GL_FRAGMENT_SHADER, "raster/shaders/" + name + ".frag", withDefines(fragmentShader, defines)}});
  return program->id();
}

}  // namespace pb
