#include "bench/presets.h"

#include <algorithm>
#include <map>

#include "bench/axes.h"

namespace pb {
namespace {

std::vector<Preset> makePresets() {
  return {
      {"three.js-cubecamera",
       {{"resolution", "256"},
        {"texture_filter", "hardware"},
        {"fresnel", "schlick"},
        {"filter", "ggx-prefiltered"},
        {"mips", "on"}},
       "three.js: one CubeCamera a mirror, updated in every frame, into a half-float target with mipmaps",
       "three.js, example webgl_materials_cubemap_dynamic; its frames are measured by the suite `external`"},
      {"gta-v",
       {{"resolution", "128"},
        {"faces", "top-half"},
        {"storage", "dual-paraboloid"},
        {"sharing", "count?probes=1"},
        {"without_probe", "nearest-probe"},
        {"capture_lod", "0.5"},
        {"texture_filter", "hardware"},
        {"fresnel", "schlick"}},
       "GTA V: one map of 128 texels for everything, its upper half with simpler geometry, as a dual paraboloid",
       "Courreges, GTA V - Graphics Study (2015); the share of triangles is a guess"},
      {"unity-individual-faces",
       {{"resolution", "128"},
        {"refresh", "faces?k=1"},
        {"texture_filter", "hardware"},
        {"fresnel", "schlick"},
        {"coats", "blended-probes"},
        {"without_probe", "blended-probes"}},
       "Unity: realtime probes, time slicing 'individual faces'",
       "Unity manual, Reflection Probe; the eight frames of convolution that follow the six faces are left out"},
      {"unity-all-faces",
       {{"resolution", "128"},
        {"refresh", "every-n?n=9"},
        {"texture_filter", "hardware"},
        {"fresnel", "schlick"},
        {"coats", "blended-probes"},
        {"without_probe", "blended-probes"}},
       "Unity: realtime probes, time slicing 'all faces at once': six faces in one frame of nine",
       "Unity manual, Reflection Probe"},
      {"godot-once",
       {{"resolution", "256"},
        {"refresh", "static"},
        {"texture_filter", "hardware"},
        {"fresnel", "schlick"},
        {"coats", "blended-probes"},
        {"without_probe", "blended-probes"}},
       "Godot: a ReflectionProbe with update mode 'once'",
       "Godot documentation, ReflectionProbe"},
      {"document-a",
       {{"resolution", "512"},
        {"texture_filter", "hardware"},
        {"fresnel", "ratio?bias=0.1&scale=0.9&power=2"},
        {"dispersion", "rgb-offset"},
        {"filter", "none"}},
       "report on dynamic reflections and refractions: a cubemap an object, last frame's maps seen in captures",
       "document A; it states neither its resolution nor its ratio"},
      {"document-b",
       {{"resolution", "1024"},
        {"bounces", "3"},
        {"feedback", "sky"},
        {"texture_filter", "hardware"},
        {"filter", "none"},
        {"placement", "origin"}},
       "blog post on environment mapping: the whole loop three times a frame, from maps that show the sky",
       "document B"},
      {"document-c",
       {{"lookup", "planar"}, {"texture_filter", "hardware"}, {"filter", "box-mips"}, {"mips", "on"}},
       "course slides: flat mirrors by a mirrored camera",
       "document C"},
      {"document-d",
       {{"lookup", "single-view"},
        {"refresh", "static"},
        {"fresnel", "ratio?bias=0.1&scale=0.9&power=2"},
        {"texture_filter", "hardware"},
        {"filter", "none"}},
       "report on a heap of monitors: one picture taken at the start for all directions",
       "document D"},
      {"document-e",
       {{"refresh", "static"},
        {"filter", "box-mips"},
        {"geometry_term", "smith-k"},
        {"fresnel", "schlick"},
        {"texture_filter", "hardware"}},
       "lab report on image-based lighting: blurred maps made once",
       "document E"},
      {"best",
       {{"resolution", "512"},
        {"bounces", "3"},
        {"lookup", "distance-impostor"},
        {"refraction", "two-interface"},
        {"coats", "blended-probes"},
        {"without_probe", "nearest-probe"},
        {"self_reflection", "split-parts"}},
       "the refinements that have the least error on their scenes in the survey, together, at any cost",
       "docs/source-documents.md"},
  };
}

std::map<std::string, Technique, std::less<>> makeTechniques() {
  std::map<std::string, Technique, std::less<>> techniques;
  for (const Preset& preset : presets()) {
    Technique technique;
    technique.preset = preset.name;
    for (const auto& [axis, value] : preset.settings) setAxis(technique, axis, value);
    techniques.emplace(preset.name, technique);
  }
  return techniques;
}

}  // namespace

const std::vector<Preset>& presets() {
  static const std::vector<Preset> table = makePresets();
  return table;
}

const Technique* presetTechnique(std::string_view name) {
  static const std::map<std::string, Technique, std::less<>> techniques = makeTechniques();
  const auto found = techniques.find(name);
  return found == techniques.end() ? nullptr : &found->second;
}

}  // namespace pb
