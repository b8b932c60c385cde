// The variants of the shaders that a device has compiled, each compiled when it is first asked for. A driver keeps some
// megabytes of each, and a suite asks for hundreds: those that nothing can use any more are freed but for the last
// ones.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "raster/gl/context.h"
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
  explicit Programs(gl::Context& context) : context_(context), gl_(context.functions()) {}

  // Keeps all programs that are asked for while it lives.
  class Use {
   public:
    explicit Use(Programs& programs) : programs_(programs), start_(programs.uses_.insert(++programs.time_).first) {}
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Programs& programs_;
    std::set<std::uint64_t>::iterator start_;
  };

  // How many there are.
  std::size_t size() const { return programs_.size(); }

  // Names of GL programs, valid until the last Use ends that was alive when they were asked for; without any, until the
  // next one ends. All throw an environment Error if the driver refuses. lookupCode: Lookup::glsl of the technique's
  // lookup.
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

  struct Compiled {
    std::unique_ptr<gl::Program> program;
    std::uint64_t asked = 0;  // when it last was
  };

  bool isIdle(const Compiled& compiled) const { return uses_.empty() || *uses_.begin() > compiled.asked; }
  void freeIdle();

  gl::Context& context_;
  const gl::Functions& gl_;
  std::map<std::string, Compiled> programs_;  // by name and defines
  std::uint64_t time_ = 0;                    // uses that have begun
  std::set<std::uint64_t> uses_;              // when those that live began
};

// Programs that stay without being in use. Sequences one after the other have most in common: of the 229 programs of a
// suite like survey 275 are compiled, with 64 of them 260.
inline constexpr std::size_t kMostIdlePrograms = 32;

}  // namespace pb
