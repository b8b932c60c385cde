// The variants of the shaders that a device has compiled, each compiled when it is first asked for.
#pragma once

#include <array>
#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "raster/gl/objects.h"
#include "raster/technique.h"
#include "scenes/scene.h"

namespace pb {

// Textures that a material may have, in the order of the slots in MaterialConstants.
inline constexpr int kMaterialTextures = 5;

// See scenes/shading/texture.glsl. Part of the variant because a sampler that the compiler knows is filtered in a
// fraction of the texel fetches: llvmpipe executes both sides of every branch.
struct SamplerSettings {
  float wrapU, wrapV, magFilter, minFilter;

  friend auto operator<=>(const SamplerSettings&, const SamplerSettings&) = default;
};

// How wide the specular lobe is over a material's texels.
enum class Lobe { smooth, rough, mixed };

// How the environment is read.
enum class EnvironmentSource { gradient, faces, facesHardware };
EnvironmentSource environmentSource(const Environment& environment, TextureFilter filter);

// What the fragments of one draw need: the cheapest variant that does it is chosen.
struct SurfaceVariant {
  float kind = shading::kSurfaceDiffuse;  // shading::kSurface*
  Lobe lobe = Lobe::smooth;
  bool reflects = true;  // its specular lobe looks something up
  std::array<std::optional<SamplerSettings>, kMaterialTextures> textures;
  bool emits = false;
  bool attributes = false;  // vertices carry more than position and normal
  TextureFilter filter = TextureFilter::exact;
  float coverage = shading::kAlphaOpaque;  // shading::kAlpha*

  friend auto operator<=>(const SurfaceVariant&, const SurfaceVariant&) = default;
};

// What is kept of a lookup (raster/shaders/lookup_records.glsl): of mirrors that are everywhere the same, less.
enum class LookupRecord { mirror, general };

// The environment's gradient and ambient light as constants of the shader: llvmpipe 22 takes long over what it reads of
// uniform blocks (docs/performance.md).
std::string environmentConstants(const Environment& environment);

// What the technique sets for the shading of all surfaces.
std::string techniqueDefines(const Technique& technique);
// Of the surfaces that look up cube maps of `resolution` texels along an edge with that filter's levels.
std::string filterDefines(ProbeFilter filter, int resolution);

class Programs {
 public:
  explicit Programs(const gl::Functions& gl) : gl_(gl) {}

  // Names of GL programs, valid as long as this object. All throw an environment Error if the driver refuses.
  // lookupCode: Lookup::glsl of the technique's lookup.
  GLuint surfaceShowingProbe(const SurfaceVariant& variant, const std::string& techniqueDefines,
                             std::string_view lookupCode);
  GLuint surfaceShowingEnvironment(const SurfaceVariant& variant, EnvironmentSource source,
                                   const std::string& techniqueDefines);
  // As surfaceShowingProbe(); writes what lookup_records.glsl keeps, too.
  GLuint surfaceRecordingLookup(const SurfaceVariant& variant, LookupRecord record, const std::string& techniqueDefines,
                                std::string_view lookupCode);
  // Of lists of lookups (raster/lookup_records.h).
  GLuint collectLookups(LookupRecord record);
  GLuint repeatLookups(LookupRecord record, const std::string& techniqueDefines);
  GLuint background(EnvironmentSource source, const std::string& environmentConstants);
  // Filters of cube maps (raster/prefilter.h).
  GLuint boxLevel(bool weighsSolidAngles, const std::string& formatDefines);
  GLuint ggxLevel(int samples, const std::string& formatDefines);
  // Conversions of maps (raster/map_conversion.h).
  GLuint copyTexels(const std::string& formatDefines);
  GLuint convertMap(Storage storage, const std::string& formatDefines);
  GLuint environmentFaces(EnvironmentSource source, int subtexels);
  GLuint ids(const SurfaceVariant& variant);
  GLuint backFaces(const SurfaceVariant& variant);
  GLuint composeLayers();
  GLuint blendHistory();
  GLuint shadow(const SurfaceVariant& variant);

 private:
  GLuint find(const char* vertexShader, const char* fragmentShader, const std::string& name, const std::string& defines,
              std::string_view fragmentCode = "");
  GLuint findCompute(const char* shader, const std::string& name, const std::string& defines);

  const gl::Functions& gl_;
  std::map<std::string, std::unique_ptr<gl::Program>> programs_;  // by name and defines
};

}  // namespace pb
