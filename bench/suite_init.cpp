#include "bench/suite_init.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "raster/planar.h"
#include "scenes/environment.h"
#include "scenes/snapshot.h"
#include "scenes/spec.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr float kMirrorLike = 0.05f;  // perceptual roughness below which a filter has nothing to do
constexpr int kLastFrame = 30;        // of what moves: later frames would show the same kind of error

bool isGlass(const Material& material) { return material.constants.kind.x == shading::kSurfaceGlass; }

bool isRoughMetal(const Material& material) {
  return material.constants.factors.x > 0.5f && material.constants.factors.y > kMirrorLike;
}

std::string tomlText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string list(const std::vector<std::string>& values) {
  std::vector<std::string> quoted;
  for (const std::string& value : values) quoted.push_back(tomlText(value));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string counted(int count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// What was found, as the suite's first comment.
std::string findingsText(const SceneTraits& traits) {
  std::vector<std::string> parts = {counted(traits.probes, "probe", "probes")};
  if (traits.mirrors > 0) parts.push_back(counted(traits.mirrors, "mirror", "mirrors"));
  if (traits.flatMirrors > 0) parts.back() += fmt::format(" ({} flat)", traits.flatMirrors);
  if (traits.glass > 0) parts.push_back(counted(traits.glass, "object of glass", "objects of glass"));
  if (traits.disperses) parts.emplace_back("dispersion");
  if (traits.roughMetals) parts.emplace_back("rough metal");
  if (traits.hasBox) parts.emplace_back("a stated box");
  parts.push_back(traits.durationSeconds > 0 ? fmt::format("{:.4g} s of motion", traits.durationSeconds)
                                             : std::string("nothing moves"));
  return fmt::format("# Found in the scene: {}.\n", fmt::join(parts, ", "));
}

std::string framesText(const SceneTraits& traits) {
  if (traits.durationSeconds <= 0)
    return "# Nothing moves, and frame 0 starts from maps that show the sky: what bounces bring is seen here, as "
           "later\n"
           "# frames gain a bounce each through the maps of the frame before.\nframes = 0\n";
  const int frames = std::max(1, static_cast<int>(traits.durationSeconds * traits.framesPerSecond));
  const int last = std::min(frames, kLastFrame);
  const int step = std::max(1, last / 6);
  return fmt::format(
      "# Measured frames; those before and between are rendered too, because what probes hold depends on them.\n"
      "frames = \"{}..{}/{}\"\n",
      std::min(step, last), last, step);
}

struct Line {
  std::string axis;
  std::vector<std::string> values;
  std::string comment;
};

std::string print(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) text += fmt::format("{} = {}  # {}\n", line.axis, list(line.values), line.comment);
  return text;
}

// Tried one at a time beside the grid.
std::vector<Line> variations(const SceneTraits& traits) {
  if (traits.probes == 0) return {};
  std::vector<Line> lines;
  Line lookup{"lookup", {"sphere-proxy", "distance-impostor"}, "where a reflected ray meets the surroundings"};
  if (traits.hasBox) lookup.values.emplace_back("box-proxy");
  if (traits.onlyFlat) lookup.values.emplace_back("planar");
  lines.push_back(lookup);
  if (traits.glass > 0)
    lines.push_back({"refraction", {"two-interface", "thick-slab"}, "the way of light through glass"});
  if (traits.disperses) lines.push_back({"dispersion", {"off", "rgb-offset"}, "colours of glass"});
  if (traits.roughMetals) lines.push_back({"filter", {"none", "box-mips"}, "of the maps that rough metals look up"});
  lines.push_back({"format", {"r11f-g11f-b10f", "rgb9e5"}, "half of the memory"});
  if (traits.castsShadows) lines.push_back({"shadow_resolution", {"256", "4096"}, "texels a side of shadow maps"});
  return lines;
}

std::string gridText(const SceneTraits& traits) {
  if (traits.probes == 0)
    return "# Nothing reflects or refracts enough to get a probe (`probebench scenes info` says why), so that no "
           "setting of\n"
           "# probes matters: one technique is measured. `use = \"file.glb?mirror=NODE\"` makes a node a mirror.\n";
  std::string text = "[grid]\nresolution = [64, 128, 256]\n";
  if (traits.durationSeconds > 0) text += "refresh = [\"every-frame\", \"faces?k=1\", \"static\"]\n";
  if (traits.probes > 1) text += "bounces = [1, 2]  # captures a frame, each seeing the maps of the one before\n";
  return text;
}

// A probe with a box of its own, or a room that is that of all.
bool hasBox(const Snapshot& snapshot) {
  return std::ranges::any_of(snapshot.probes, [](const Probe& probe) { return probe.proxyBox.has_value(); });
}

bool isBuiltin(const std::string& name) { return name.starts_with("builtin:"); }

std::string absolutePath(const std::string& path) { return fs::absolute(path).lexically_normal().string(); }

}  // namespace

SceneTraits traitsOf(const std::shared_ptr<const Scene>& scene) {
  constexpr double kAspect = 16.0 / 9.0;
  const auto snapshot = makeSnapshot(scene, 0, scene->cameras.front().name, kAspect);
  SceneTraits traits;
  traits.probes = static_cast<int>(snapshot->probes.size());
  traits.onlyFlat = traits.probes > 0;
  for (const SnapshotInstance& instance : snapshot->instances) {
    const Material& material = snapshot->materialOf(instance);
    traits.roughMetals = traits.roughMetals || isRoughMetal(material);
    if (instance.probe < 0) continue;
    const bool flat = planeOf(instance).has_value();
    ++(isGlass(material) ? traits.glass : traits.mirrors);
    if (!isGlass(material) && flat) ++traits.flatMirrors;
    traits.onlyFlat = traits.onlyFlat && flat && !isGlass(material);
    traits.disperses = traits.disperses || (isGlass(material) && material.constants.kind.w > 0.0f);
  }
  traits.hasBox = hasBox(*snapshot);
  traits.castsShadows = scene->castsShadows && !scene->lights.empty();
  traits.durationSeconds = scene->durationSeconds;
  traits.framesPerSecond = scene->framesPerSecond;
  return traits;
}

std::string makeSuiteText(const std::string& name, const std::string& use, const SceneTraits& traits) {
  // Only rough surfaces and glass have noise to get rid of.
  const bool noisy = traits.glass > 0 || traits.roughMetals || traits.castsShadows;
  std::string text = findingsText(traits);
  text +=
      "# `probebench run THIS_FILE --dry-run` says what it renders and how long that should take. Axes and values:\n"
      "# `probebench axes list`, `probebench axes info AXIS`.\n";
  text += fmt::format("schema = 1\nname = {}\n", tomlText(name));
  text += "image = { size = [320, 180], samples = 4 }  # larger for final numbers\n";
  text += fmt::format("reference = {{ depth = \"converged\", max_noise = {} }}{}\n", noisy ? "1e-3" : "1e-5",
                      noisy ? "  # smaller where results are not clear of noise" : "");
  text += "cost = { repetitions = 6 }  # 0: errors only\n\n";
  text += fmt::format("[[scene]]\nuse = {}\n{}", tomlText(use), framesText(traits));
  if (const std::vector<Line> lines = variations(traits); !lines.empty())
    text += "\n# Each of these for itself, on top of each technique of the grid.\n[scene.vary]\n" + print(lines);
  text += '\n' + gridText(traits);
  if (traits.probes > 0)
    text +=
        "\n# Where the error of a technique comes from: bounces, lookup, resolution, capture, format, or old maps.\n"
        "[attribution]\nresolution = 512  # texels a side of maps that stand for perfect ones; 1024 for final "
        "numbers\n";
  text +=
      "\n# How far a metric may move before `probebench check` fails.\n[tolerance]\n"
      "flip_hdr = { relative = 0.02, absolute = 1e-4 }\nrelmse = { relative = 0.05, absolute = 1e-5 }\n";
  return text;
}

std::string sceneFromFolder(const std::string& reference, const std::string& folder) {
  Spec spec = parseSpec(reference);
  if (!isBuiltin(spec.name)) {
    const fs::path relative = fs::path(absolutePath(spec.name)).lexically_relative(absolutePath(folder));
    spec.name = relative.empty() ? absolutePath(spec.name) : relative.string();
  }
  for (auto& [key, value] : spec.parameters) {
    if (key != "environment") continue;
    std::vector<TimedEnvironment> environments = parseEnvironments(value);
    for (TimedEnvironment& environment : environments)
      if (fs::exists(environment.text)) environment.text = absolutePath(environment.text);
    value = printEnvironments(environments);
  }
  return printSpec(spec);
}

}  // namespace pb
