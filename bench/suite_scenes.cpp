#include "bench/suite_scenes.h"

#include <algorithm>
#include <filesystem>

#include "bench/suite_tolerance.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxFrame = 1'000'000;
constexpr std::size_t kMaxFrames = 10'000;  // a scene
constexpr double kMaxStops = 32;

int parseFrame(std::string_view text) {
  const std::optional<long long> frame = parseInteger(text);
  if (!frame || *frame < 0 || *frame > kMaxFrame)
    throwInputError("a frame is an integer from 0 to {}, got '{}'", kMaxFrame, text);
  return static_cast<int>(*frame);
}

// "8", "0..7" or, every fourth of them, "0..60/4".
std::vector<int> parseFrames(std::string_view text) {
  const std::size_t dots = text.find("..");
  const int first = parseFrame(text.substr(0, dots));
  if (dots == std::string_view::npos) return {first};
  const std::string_view rest = text.substr(dots + 2);
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const int last = parseFrame(rest.substr(0, slash));
  const std::optional<long long> step = slash == rest.size() ? 1 : parseInteger(rest.substr(slash + 1));
  if (!step || *step < 1 || *step > kMaxFrame)
    throwInputError("the step of 'frames' is an integer from 1 to {}, as in \"0..60/4\", got '{}'", kMaxFrame, text);
  const auto every = static_cast<int>(*step);
  if (last < first || static_cast<std::size_t>((last - first) / every) >= kMaxFrames)
    throwInputError("'frames' wants an increasing range of at most {} frames, got '{}'", kMaxFrames, text);
  std::vector<int> frames;
  for (int frame = first; frame <= last; frame += every) frames.push_back(frame);
  return frames;
}

std::vector<int> readFrames(const toml::node& node, const std::string& file) {
  if (!node.is_array()) return atPlace(file, node, [&] { return parseFrames(scalarText(node, "frames", file)); });
  std::vector<int> frames;
  for (const toml::node& value : *node.as_array()) {
    frames.push_back(atPlace(file, value, [&] { return parseFrame(scalarText(value, "frames", file)); }));
    if (frames.size() > 1 && frames.back() <= frames[frames.size() - 2])
      throwInputError("{}: 'frames' wants increasing numbers, got {} after {}", placeOf(file, value), frames.back(),
                      frames[frames.size() - 2]);
  }
  if (frames.empty() || frames.size() > kMaxFrames)
    throwInputError("{}: 'frames' wants 1 to {} frames, got {}", placeOf(file, node), kMaxFrames, frames.size());
  return frames;
}

bool isPath(const std::string& reference) { return !reference.starts_with("builtin:"); }

// Environments that loadEnvironment() makes without a file.
bool isEnvironmentFile(const std::string& environment) {
  const std::string name = parseSpec(environment).name;
  return name != "sky" && name != "black" && name != "white" && name != "constant";
}

std::string inFolder(const std::string& path, const std::string& folder) { return (fs::path(folder) / path).string(); }

// With the files among the environments relative to the folder.
std::string environmentsInFolder(const std::string& text, const std::string& folder) {
  std::vector<TimedEnvironment> environments = parseEnvironments(text);
  for (TimedEnvironment& environment : environments)
    if (isEnvironmentFile(environment.text)) environment.text = inFolder(environment.text, folder);
  return printEnvironments(environments);
}

// Options of loadScene() that a suite may give beside `use`.
using SceneOptions = std::vector<std::pair<std::string, std::string>>;

SceneOptions readSceneOptions(TomlReader& reader) {
  SceneOptions options;
  for (const char* option : {"environment", "shadows"})
    if (const std::optional<std::string> value = reader.text(option)) options.emplace_back(option, *value);
  for (const char* option : {"fps", "time_step"})
    if (const std::optional<double> value = reader.number(option, 1e-3, 1e3))
      options.emplace_back(option, fmt::format("{}", *value));
  return options;
}

// The scene as loadScene() wants it: paths relative to the suite's folder, the suite's options joined to its own.
std::string sceneReference(const std::string& use, const SceneOptions& options, const std::string& folder) {
  Spec spec = parseSpec(use);
  for (const auto& [option, value] : options) {
    if (std::ranges::find(spec.parameters, option, &SceneOptions::value_type::first) != spec.parameters.end())
      throwInputError("'{}' stands both in '{}' and beside it", option, use);
    spec.parameters.emplace_back(option, value);
  }
  if (isPath(spec.name)) spec.name = inFolder(spec.name, folder);
  for (auto& [key, value] : spec.parameters)
    if (key == "environment") value = environmentsInFolder(value, folder);
  return printSpec(spec);
}

SuiteScene readScene(const toml::table& table, const std::string& file, const std::string& folder,
                     const ToleranceLevels& tolerance) {
  TomlReader reader(table, file, "a [[scene]]");
  SuiteScene scene;
  const toml::node& use = reader.require("use");
  scene.name = reader.text("use").value();
  const SceneOptions options = readSceneOptions(reader);
  scene.reference = atPlace(file, use, [&] { return sceneReference(scene.name, options, folder); });
  Spec named = parseSpec(scene.name);
  named.parameters.insert(named.parameters.end(), options.begin(), options.end());
  scene.name = printSpec(named);
  if (const toml::node* frames = reader.find("frames")) scene.frames = readFrames(*frames, file);
  if (const auto warmup = reader.integer("warmup", 0, 1000)) scene.warmup = static_cast<int>(*warmup);
  scene.camera = reader.text("camera").value_or("");
  scene.vary = readVariations(reader);
  scene.tolerance = readSceneTolerances(reader, tolerance);
  scene.exposure = reader.number("exposure", -kMaxStops, kMaxStops).value_or(0);
  reader.finish();
  return scene;
}

}  // namespace

std::vector<SuiteScene> readScenes(TomlReader& suite, const std::string& folder, const ToleranceLevels& tolerance) {
  const toml::node& node = suite.require("scene");
  std::vector<SuiteScene> scenes;
  for (const toml::node& scene : asArray(node, "scene", suite.file())) {
    scenes.push_back(readScene(asTable(scene, "scene", suite.file()), suite.file(), folder, tolerance));
    const auto same = [&](const SuiteScene& s) {
      return s.name == scenes.back().name && s.camera == scenes.back().camera;
    };
    if (std::ranges::count_if(scenes, same) > 1)
      throwInputError("{}: scene '{}' stands twice with the same camera", placeOf(suite.file(), scene),
                      scenes.back().name);
  }
  if (scenes.empty()) throwInputError("{}: the suite needs at least one [[scene]]", placeOf(suite.file(), node));
  return scenes;
}

}  // namespace pb
