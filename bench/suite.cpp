#include "bench/suite.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "bench/axes.h"
#include "bench/metrics/metrics.h"
#include "bench/suite_scenes.h"
#include "bench/suite_tolerance.h"
#include "bench/toml_reader.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/spec.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr int kSuiteSchemaVersion = 1;
constexpr int kMaxImageSidePx = 16384;  // samples along a side: the largest texture that OpenGL 4.5 must offer
constexpr int kMaxDepth = 64;

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

// A run goes to out/NAME.
std::string readName(TomlReader& suite) {
  const toml::node& node = suite.require("name");
  const std::string name = suite.text("name").value();
  if (name.empty() || name.starts_with('.') || name.find('/') != std::string::npos)
    throwInputError("{}: 'name' is a folder's: it is not empty, has no '/' and doesn't begin with a point, got '{}'",
                    placeOf(suite.file(), node), name);
  return name;
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
  Suite suite;
  suite.name = readName(reader);
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
