#include "bench/suite.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "bench/axes.h"
#include "bench/metrics/metrics.h"
#include "bench/suite_tolerance.h"
#include "bench/toml_reader.h"
#include "scenes/environment.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/spec.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr int kSuiteSchemaVersion = 1;
constexpr int kMaxImageSidePx = 16384;  // samples along a side: the largest texture that OpenGL 4.5 must offer
constexpr int kMaxFrame = 1'000'000;
constexpr std::size_t kMaxFrames = 10'000;  // a scene
constexpr int kMaxDepth = 64;
constexpr double kMaxStops = 32;

ImageSettings readImage(TomlReader& suite) {
  ImageSettings image;
  std::optional<TomlReader> reader = suite.child("image");
  if (!reader) return image;
  if (const toml::node* size = reader->find("size")) {
    const toml::array& sides = asArray(*size, "size", suite.file());
    if (sides.size() != 2)
      throwInputError("{}: 'size' wants [width, height], got {} values", placeOf(suite.file(), *size), sides.size());
    std::tie(image.widthPx, image.heightPx) = atPlace(suite.file(), *size, [&] {
      return parseSize(
          fmt::format("{}x{}", scalarText(sides[0], "size", suite.file()), scalarText(sides[1], "size", suite.file())));
    });
  }
  if (const auto samples = reader->integer("samples", 1, 64))
    image.samplesPerAxis = atPlace(suite.file(), *reader->find("samples"), [&] { return samplesPerAxisOf(*samples); });
  reader->finish();
  const int longest = std::max(image.widthPx, image.heightPx) * image.samplesPerAxis;
  if (longest > kMaxImageSidePx)
    throwInputError("{}: 'image' may have at most {} samples along a side, got {}",
                    placeOf(suite.file(), reader->table()), kMaxImageSidePx, longest);
  return image;
}

PictureSettings readPictures(TomlReader& suite) {
  PictureSettings pictures;
  std::optional<TomlReader> reader = suite.child("images");
  if (!reader) return pictures;
  if (const auto frames = reader->text("frames")) {
    if (*frames != "all" && *frames != "last")
      throwInputError("{}: 'frames' of 'images' wants \"last\" or \"all\", got '{}'",
                      placeOf(suite.file(), *reader->find("frames")), *frames);
    pictures.everyFrame = *frames == "all";
  }
  reader->finish();
  return pictures;
}

void readDiffuse(TomlReader& reference, TruthSettings& truth) {
  if (const toml::node* node = reference.find("diffuse"))
    truth.diffuse =
        atPlace(reference.file(), *node, [&] { return parseDiffuse(scalarText(*node, "diffuse", reference.file())); });
  const auto depth = reference.integer("diffuse_depth", 0, kMaxDepth);
  if (depth && truth.diffuse == DiffuseTransport::local)
    throwInputError("{}: 'diffuse_depth' belongs to diffuse = \"traced\"",
                    placeOf(reference.file(), reference.require("diffuse_depth")));
  if (depth) truth.diffuseDepth = static_cast<int>(*depth);
}

TruthSettings readReference(TomlReader& suite) {
  TruthSettings truth;
  std::optional<TomlReader> reader = suite.child("reference");
  if (!reader) return truth;
  if (const toml::node* depth = reader->find("depth"))
    truth.depth = atPlace(suite.file(), *depth, [&] { return parseDepth(scalarText(*depth, "depth", suite.file())); });
  readDiffuse(*reader, truth);
  if (const auto spp = reader->integer("spp", 2, kMaxSpp)) {
    if (*spp % 2 != 0)
      throwInputError("{}: 'spp' wants an even number, one half for each of two images, got {}",
                      placeOf(suite.file(), reader->require("spp")), *spp);
    truth.spp = static_cast<int>(*spp);
  }
  truth.maxNoise = reader->number("max_noise", 0, 1);
  if (const toml::node* matched = reader->find("matched")) {
    if (!matched->is_boolean()) throwInputError("{}: 'matched' wants true or false", placeOf(suite.file(), *matched));
    truth.matched = matched->as_boolean()->get();
  }
  reader->finish();
  return truth;
}

CostSettings readCost(TomlReader& suite) {
  CostSettings cost;
  std::optional<TomlReader> reader = suite.child("cost");
  if (!reader) return cost;
  if (const auto repetitions = reader->integer("repetitions", 0, 1000))
    cost.repetitions = static_cast<int>(*repetitions);
  reader->finish();
  return cost;
}

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

toml::table parseToml(const std::string& text, const std::string& place) {
  try {
    return toml::parse(text, place);
  } catch (const toml::parse_error& error) {
    throwInputError("{}:{}: {}", place, error.source().begin.line, error.description());
  }
}

// The folder of the shipped suites: that of the source tree, or of the installation beside the program.
fs::path shippedFolder() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  const fs::path installed = program.parent_path().parent_path() / "share" / "probebench" / "suites";
  return fs::is_directory(installed) ? installed : fs::path(PROBEBENCH_SUITES_DIR);
}

std::string shippedPath(const std::string& name) {
  const std::vector<std::string> names = shippedSuites();
  if (std::ranges::find(names, name) == names.end())
    throwInputError("a suite is a .toml file or the name of a shipped one; {}", unknownMessage(name, names));
  return (shippedFolder() / (name + ".toml")).string();
}

std::string framesText(const SuiteScene& scene) {
  std::string text = fmt::format("from {}:", scene.startFrame());
  for (const int frame : scene.frames) text += fmt::format(" {}", frame);
  return text;
}

}  // namespace

Suite parseSuite(const std::string& toml, const std::string& place, const std::string& folder) {
  const toml::table root = parseToml(toml, place);
  TomlReader reader(root, place, "the suite");
  reader.require("schema");
  if (reader.integer("schema", 1, std::numeric_limits<int>::max()) != kSuiteSchemaVersion)
    throwInputError("{}: 'schema' wants {}, the only version there is", placeOf(place, reader.require("schema")),
                    kSuiteSchemaVersion);
  reader.require("name");
  Suite suite;
  suite.name = reader.text("name").value();
  suite.image = readImage(reader);
  suite.pictures = readPictures(reader);
  suite.reference = readReference(reader);
  suite.cost = readCost(reader);
  suite.technique = readTechnique(reader);
  ToleranceLevels tolerance = readSuiteTolerances(reader);
  suite.scenes = readScenes(reader, folder, tolerance);
  suite.grid = readAxes(reader, "grid");
  suite.externals = readExternalTechniques(reader, folder);
  suite.attribution = readAttribution(reader);
  suite.tolerance = std::move(tolerance.fail);
  suite.warnTolerance = std::move(tolerance.warn);
  reader.finish();
  return suite;
}

Suite loadSuite(const std::string& fileOrName) {
  const std::string path =
      fileOrName.ends_with(".toml") || fs::is_regular_file(fileOrName) ? fileOrName : shippedPath(fileOrName);
  return parseSuite(readFile(path), path, fs::path(path).parent_path().string());
}

std::vector<std::string> shippedSuites() {
  std::vector<std::string> names;
  std::error_code noFolder;
  for (const fs::directory_entry& entry : fs::directory_iterator(shippedFolder(), noFolder))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

SceneTolerances sceneTolerancesOf(const Suite& suite) {
  SceneTolerances tolerances;
  for (const SuiteScene& scene : suite.scenes)
    if (scene.tolerance != ToleranceLevels()) tolerances[toleranceScope(scene.name, scene.camera)] = scene.tolerance;
  return tolerances;
}

void setGridAxis(Suite& suite, GridAxis axis) {
  std::erase_if(suite.grid, [&](const GridAxis& other) { return other.first == axis.first; });
  suite.grid.push_back(std::move(axis));
  const auto order = [](const GridAxis& a) {
    return std::ranges::find(axisTable(), a.first, &Axis::name) - axisTable().begin();
  };
  std::ranges::sort(suite.grid, {}, order);
}

SuiteScene sceneLike(const SuiteScene& like, const std::string& reference) {
  SuiteScene scene = like;
  scene.name = scene.reference = reference;
  scene.camera.clear();
  return scene;
}

std::string canonicalText(const Suite& suite) {
  std::string text = fmt::format("image {}x{} {}\nreference {} {} {} {} {}\ncost {}\n", suite.image.widthPx,
                                 suite.image.heightPx, suite.image.samplesPerAxis, suite.reference.depth.value_or(0),
                                 printDiffuse(suite.reference.diffuse), suite.reference.diffuseDepth.value_or(-1),
                                 suite.reference.spp, suite.reference.maxNoise.value_or(-1), suite.cost.repetitions);
  if (!suite.reference.matched) text += "reference matched off\n";
  // Without what stands at its default: a new axis doesn't change suites that don't name it.
  for (const Axis& axis : axisTable())
    if (const std::string value = axis.print(suite.technique); value != axis.print(Technique()))
      text += fmt::format("{} = {}\n", axis.name, value);
  for (const SuiteScene& scene : suite.scenes)
    text += fmt::format("scene {} camera '{}' exposure {} frames {}\n", scene.name, scene.camera, scene.exposure,
                        framesText(scene));
  for (const SuiteScene& scene : suite.scenes)
    for (const Variation& variation : scene.vary) text += canonicalText(scene.name, variation);
  for (const auto& [axis, values] : suite.grid) text += fmt::format("grid {} = {}\n", axis, fmt::join(values, ","));
  for (const ExternalTechnique& external : suite.externals) text += fmt::format("external {}\n", external.canonical);
  return text + canonicalText(suite.attribution);
}

std::pair<int, int> parseSize(std::string_view text) {
  const std::size_t x = text.find('x');
  const auto side = [&](std::string_view digits) {
    const std::optional<long long> value = parseInteger(digits);
    if (x == std::string_view::npos || !value || *value < 16 || *value > kMaxImageSidePx)
      throwInputError("an image size is WIDTHxHEIGHT with sides from 16 to {}, got '{}'", kMaxImageSidePx, text);
    return static_cast<int>(*value);
  };
  return {side(text.substr(0, x)), side(x == std::string_view::npos ? text : text.substr(x + 1))};
}

int samplesPerAxisOf(long long samples) {
  const int root = static_cast<int>(std::lround(std::sqrt(static_cast<double>(samples))));
  if (samples < 1 || samples > 64 || static_cast<long long>(root) * root != samples)
    throwInputError("samples wants a square number from 1 to 64, got {}", samples);
  return root;
}

std::optional<int> parseDepth(std::string_view text) {
  if (text == "converged") return std::nullopt;
  const std::optional<long long> depth = parseInteger(text);
  if (!depth || *depth < 1 || *depth > kMaxDepth)
    throwInputError("depth wants 'converged' or an integer from 1 to {}, got '{}'", kMaxDepth, text);
  return static_cast<int>(*depth);
}

DiffuseTransport parseDiffuse(std::string_view text) {
  if (text == "local") return DiffuseTransport::local;
  if (text == "traced") return DiffuseTransport::traced;
  throwInputError("diffuse wants 'local' or 'traced', got '{}'", text);
}

std::string printDiffuse(DiffuseTransport diffuse) { return diffuse == DiffuseTransport::traced ? "traced" : "local"; }

}  // namespace pb
