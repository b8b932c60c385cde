#include "raster/programs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "raster/prefilter.h"
#include "raster/shaders/back_faces.frag.h"
#include "raster/shaders/background.frag.h"
#include "raster/shaders/background.vert.h"
#include "raster/shaders/blend_history.frag.h"
#include "raster/shaders/collect_lookups.comp.h"
#include "raster/shaders/compose_layers.frag.h"
#include "raster/shaders/convert_map.comp.h"
#include "raster/shaders/copy_texels.comp.h"
#include "raster/shaders/ids.frag.h"
#include "raster/shaders/prefilter_box.comp.h"
#include "raster/shaders/prefilter_ggx.comp.h"
#include "raster/shaders/prefilter_source.comp.h"
#include "raster/shaders/repeat_lookups.comp.h"
#include "raster/shaders/scene.frag.h"
#include "raster/shaders/scene.vert.h"
#include "raster/shaders/shadow.frag.h"

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

// Nine digits: all of a float. GLSL has no literals of what isn't finite.
std::string glslOf(float v) {
  return std::isfinite(v) ? fmt::format("{:#.9g}f", v)
                          : fmt::format("uintBitsToFloat({:#x}u)", std::bit_cast<std::uint32_t>(v));
}

std::string glslOf(const glm::vec4& v) {
  return fmt::format("vec4({}, {}, {}, {})", glslOf(v.x), glslOf(v.y), glslOf(v.z), glslOf(v.w));
}

// A constructor of a struct of vec4.
std::string glslOf(const std::string& name, std::initializer_list<glm::vec4> members) {
  std::vector<std::string> values;
  for (const glm::vec4& member : members) values.push_back(glslOf(member));
  return fmt::format("{}({})", name, fmt::join(values, ", "));
}

std::string coverageDefine(float coverage) {
  if (coverage == shading::kAlphaMask) return define("ALPHA_MASK");
  return coverage == shading::kAlphaBlend ? define("ALPHA_BLEND") : "";
}

std::string lobeDefines(Lobe lobe) {
  if (lobe == Lobe::smooth) return "";
  return define("ROUGH_LOBE") + (lobe == Lobe::mixed ? define("SMOOTH_TEXELS") : "");
}

std::string definesOf(const SurfaceVariant& variant) {
  std::string defines = define("SURFACE_KIND", fmt::format("{:.1f}", variant.kind)) + coverageDefine(variant.coverage);
  defines += lobeDefines(variant.lobe);
  if (!variant.reflects) defines += define("NO_REFLECTION");
  if (variant.attributes) defines += define("ATTRIBUTES");
  if (variant.emits) defines += define("EMITS");
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

std::string definesOf(LookupRecord record) { return record == LookupRecord::mirror ? define("MIRROR_RECORDS") : ""; }

// The #version line has to stay the first.
std::string withDefines(const std::string& shader, const std::string& defines) {
  const std::size_t secondLine = shader.find('\n') + 1;
  return shader.substr(0, secondLine) + defines + shader.substr(secondLine);
}

// At the end; the driver's messages count its lines from 1 again.
std::string withCode(const std::string& shader, std::string_view code) {
  return code.empty() ? shader : fmt::format("{}#line 1 1\n{}", shader, code);
}

}  // namespace

EnvironmentSource environmentSource(const Environment& environment, TextureFilter filter) {
  if (environment.sky.toGlow.w <= 0.5f) return EnvironmentSource::gradient;
  return filter == TextureFilter::hardware ? EnvironmentSource::facesHardware : EnvironmentSource::faces;
}

std::string environmentConstants(const Environment& environment) {
  const shading::Sky& sky = environment.sky;
  const shading::Ambient& a = environment.ambient;
  return define("SKY", glslOf("Sky", {sky.horizon, sky.zenith, sky.below, sky.glow, sky.toGlow})) +
         define("AMBIENT", glslOf("Ambient", {a.constant, a.y, a.z, a.x, a.xy, a.yz, a.zz, a.xz, a.xxyy}));
}

std::string techniqueDefines(const Technique& technique) {
  return define("FRESNEL_LAW", glslOf(fresnelLaw(technique.fresnel))) +
         define("GEOMETRY_TERM", fmt::format("{:.1f}", static_cast<double>(technique.geometryTerm)));
}

std::string filterDefines(ProbeFilter filter, int resolution) {
  const int levels = filteredLevels(filter, resolution);
  if (levels <= 0) return "";
  if (filter == ProbeFilter::boxMips) return define("FILTER_BOX", fmt::format("{}.0f", resolution));
  return define("FILTER_GGX", fmt::format("{}.0f", levels));
}

GLuint Programs::surfaceShowingProbe(const SurfaceVariant& variant, const std::string& techniqueDefines,
                                     std::string_view lookupCode) {
  return find(shaders::kSceneVert, shaders::kSceneFrag, "scene",
              definesOf(variant) + techniqueDefines + define("PROBE_LOOKUP"), lookupCode);
}

GLuint Programs::surfaceShowingEnvironment(const SurfaceVariant& variant, EnvironmentSource source,
                                           const std::string& techniqueDefines) {
  return find(shaders::kSceneVert, shaders::kSceneFrag, "scene",
              definesOf(variant) + techniqueDefines + definesOf(source));
}

GLuint Programs::surfaceRecordingLookup(const SurfaceVariant& variant, LookupRecord record,
                                        const std::string& techniqueDefines, std::string_view lookupCode) {
  return surfaceShowingProbe(variant, techniqueDefines + define("RECORDS_LOOKUP") + definesOf(record), lookupCode);
}

GLuint Programs::collectLookups(LookupRecord record) {
  return findCompute(shaders::kCollectLookupsComp, "collect_lookups", definesOf(record));
}

GLuint Programs::repeatLookups(LookupRecord record, const std::string& techniqueDefines) {
  return findCompute(shaders::kRepeatLookupsComp, "repeat_lookups", techniqueDefines + definesOf(record));
}

GLuint Programs::background(EnvironmentSource source, const std::string& environmentConstants) {
  return find(shaders::kBackgroundVert, shaders::kBackgroundFrag, "background",
              definesOf(source) + environmentConstants);
}

GLuint Programs::boxLevel(bool weighsSolidAngles, const std::string& formatDefines) {
  return findCompute(shaders::kPrefilterBoxComp, "prefilter_box",
                     formatDefines + (weighsSolidAngles ? define("SOLID_ANGLES") : ""));
}

GLuint Programs::ggxLevel(int samples, const std::string& formatDefines) {
  return findCompute(shaders::kPrefilterGgxComp, "prefilter_ggx",
                     formatDefines + define("LOBE_SAMPLES", std::to_string(samples)));
}

GLuint Programs::copyTexels(const std::string& formatDefines) {
  return findCompute(shaders::kCopyTexelsComp, "copy_texels", formatDefines);
}

GLuint Programs::convertMap(Storage storage, const std::string& formatDefines) {
  return findCompute(shaders::kConvertMapComp, "convert_map",
                     formatDefines + (storage == Storage::octahedral ? define("OCTAHEDRAL") : ""));
}

GLuint Programs::environmentFaces(EnvironmentSource source, int subtexels) {
  return findCompute(shaders::kPrefilterSourceComp, "prefilter_source",
                     definesOf(source) + define("SUBTEXELS", std::to_string(subtexels)));
}

// Ids follow the exact filter's choice of texels whatever the filter.
GLuint Programs::ids(const SurfaceVariant& variant) {
  SurfaceVariant geometry;
  geometry.attributes = variant.attributes;
  geometry.coverage = variant.coverage;
  geometry.textures[0] = variant.textures[0];
  return find(shaders::kSceneVert, shaders::kIdsFrag, "ids", definesOf(geometry));
}

// Of a surface that is there everywhere only the shape matters.
GLuint Programs::shadow(const SurfaceVariant& variant) {
  SurfaceVariant caster;
  if (variant.coverage != shading::kAlphaOpaque) {
    caster.attributes = variant.attributes;
    caster.coverage = variant.coverage;
    caster.filter = variant.filter;
    caster.textures[0] = variant.textures[0];
  }
  return find(shaders::kSceneVert, shaders::kShadowFrag, "shadow", definesOf(caster) + define("SHADOW_PASS"));
}

GLuint Programs::blendHistory() {
  return find(shaders::kBackgroundVert, shaders::kBlendHistoryFrag, "blend_history", "");
}

GLuint Programs::composeLayers() {
  return find(shaders::kBackgroundVert, shaders::kComposeLayersFrag, "compose_layers", "");
}

// Of a surface's textures only those of its normals and holes matter behind it.
GLuint Programs::backFaces(const SurfaceVariant& variant) {
  constexpr std::size_t kNormalTexture = 2;
  SurfaceVariant geometry;
  geometry.attributes = variant.attributes;
  geometry.filter = variant.filter;
  geometry.textures[kNormalTexture] = variant.textures[kNormalTexture];
  geometry.coverage = variant.coverage;
  if (variant.coverage != shading::kAlphaOpaque) geometry.textures[0] = variant.textures[0];
  return find(shaders::kSceneVert, shaders::kBackFacesFrag, "back_faces", definesOf(geometry));
}

GLuint Programs::find(const char* vertexShader, const char* fragmentShader, const std::string& name,
                      const std::string& defines, std::string_view fragmentCode) {
  Compiled& found = programs_[fmt::format("{}\n{}{}", name, defines, fragmentCode)];
  found.asked = time_;
  if (found.program) return found.program->id();
  const std::string fragment = withCode(withDefines(fragmentShader, defines), fragmentCode);
  found.program = std::make_unique<gl::Program>(
      gl_, std::vector<gl::ShaderSource>{
               {GL_VERTEX_SHADER, "raster/shaders/" + name + ".vert", withDefines(vertexShader, defines)},
               {GL_FRAGMENT_SHADER, "raster/shaders/" + name + ".frag", fragment}});
  return found.program->id();
}

GLuint Programs::findCompute(const char* shader, const std::string& name, const std::string& defines) {
  Compiled& found = programs_[name + "\n" + defines];
  found.asked = time_;
  if (!found.program)
    found.program = std::make_unique<gl::Program>(
        gl_, std::vector<gl::ShaderSource>{
                 {GL_COMPUTE_SHADER, "raster/shaders/" + name + ".comp", withDefines(shader, defines)}});
  return found.program->id();
}

Programs::Use::~Use() {
  programs_.uses_.erase(start_);
  programs_.freeIdle();
}

// Those that were asked for longest ago go first.
void Programs::freeIdle() {
  std::vector<std::map<std::string, Compiled>::iterator> idle;
  for (auto compiled = programs_.begin(); compiled != programs_.end(); ++compiled)
    if (isIdle(compiled->second)) idle.push_back(compiled);
  if (idle.size() <= kMostIdlePrograms) return;
  context_.makeCurrent();
  std::ranges::stable_sort(idle, {}, [](const auto& compiled) { return compiled->second.asked; });
  for (std::size_t i = 0; i + kMostIdlePrograms < idle.size(); ++i) programs_.erase(idle[i]);
}

}  // namespace pb
