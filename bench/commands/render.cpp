#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bench/axes.h"
#include "bench/commands/commands.h"
#include "bench/commands/validators.h"
#include "bench/interrupt.h"
#include "bench/oracle.h"
#include "bench/suite.h"
#include "raster/lookup.h"
#include "reference/renderer.h"
#include "scenes/error.h"
#include "scenes/image_io.h"
#include "scenes/snapshot.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string scene, renderer, output, camera;
  std::string size = "640x360", depth = "converged", diffuse = "local";
  std::string sampling = "sobol";
  int samples = 4, frame = 0, spp = 16;
  std::uint64_t seed = 1;
  double exposure = 0;
  std::optional<int> diffuseDepth;
  std::vector<std::string> settings, aovs;
};

// What the options say, checked before anything is rendered.
struct RenderJob {
  std::shared_ptr<const Scene> scene;
  ImageSettings image;
  Technique technique;
  ReferenceSettings reference;
  std::string idsPath;  // empty: no object ids are wanted
};

struct Rendered {
  Image image;
  Grid<SampleId> ids;  // empty unless asked for
};

// In the order of the axis table, as in `run`: a preset, which sets every axis, before the others.
Technique parseTechnique(const std::vector<std::string>& settings) {
  std::map<std::string, std::string> values;
  for (const std::string& text : settings) {
    const auto [axis, given] = parseAxisValues(text);
    if (given.size() != 1) throwInputError("--set of render takes one value, got '{}'", text);
    if (!values.emplace(axis, given.front()).second) throwInputError("--set names axis '{}' twice", axis);
  }
  Technique technique;
  for (const Axis& axis : axisTable())
    if (const auto value = values.find(axis.name); value != values.end()) setAxis(technique, axis.name, value->second);
  return technique;
}

std::string parseAovs(const std::vector<std::string>& aovs) {
  std::string path;
  for (const std::string& aov : aovs) {
    if (!aov.starts_with("ids=") || !aov.ends_with(".exr"))
      throwInputError("--aov wants ids=FILE.exr, the only one there is, got '{}'", aov);
    path = aov.substr(4);
  }
  return path;
}

// A picture may take hours: whether there is a place for it is found out before.
void requirePlace(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throwEnvironmentError("can't write '{}': there is no folder '{}'", path, folder.string());
  if (fs::is_directory(path)) throwEnvironmentError("can't write '{}': it is a folder", path);
}

void checkOutputs(const std::string& picture, const std::string& ids) {
  if (!picture.ends_with(".exr") && !picture.ends_with(".png"))
    throwInputError("an image is written as .exr or .png, got '{}'", picture);
  requirePlace(picture);
  if (ids.empty()) return;
  requirePlace(ids);
  // What isn't there has no canonical form of its own, its folder has.
  const auto placeOf = [](const fs::path& path) {
    return fs::canonical(fs::absolute(path).parent_path()) / path.filename();
  };
  if (placeOf(ids) == placeOf(picture)) throwInputError("-o and --aov want different files, got '{}' twice", ids);
}

RenderJob parseJob(const RenderOptions& options) {
  RenderJob job;
  job.idsPath = parseAovs(options.aovs);
  checkOutputs(options.output, job.idsPath);
  std::tie(job.image.widthPx, job.image.heightPx) = parseSize(options.size);
  job.image.samplesPerAxis = samplesPerAxisOf(options.samples);
  job.technique = parseTechnique(options.settings);
  job.reference.samplesPerAxis = job.image.samplesPerAxis;
  job.reference.depth = parseDepth(options.depth);
  job.reference.diffuse = parseDiffuse(options.diffuse);
  job.reference.diffuseDepth = options.diffuseDepth;
  if (options.diffuseDepth && job.reference.diffuse == DiffuseTransport::local)
    throwInputError("--diffuse-depth belongs to --diffuse traced");
  job.reference.spp = options.spp;
  job.reference.seed = options.seed;
  job.reference.sampling = options.sampling == "sobol" ? Sampling::sobol : Sampling::independent;
  job.scene = loadScene(options.scene);
  return job;
}

std::shared_ptr<const Snapshot> snapshotOf(const RenderOptions& options, const RenderJob& job, int frame) {
  return makeSnapshot(job.scene, frame, options.camera, job.image.aspect());
}

// Renders the frames before as well: what the probes hold depends on them.
Rendered renderRaster(const RenderOptions& options, const RenderJob& job, const GlobalOptions& globals) {
  const ImageSettings& image = job.image;
  RasterDevice device(globals.backend());
  RasterSequence sequence(device, job.technique, image.widthPx, image.heightPx, image.samplesPerAxis);
  for (int frame = 0; frame <= options.frame; ++frame) {
    throwIfInterrupted();
    sequence.renderFrame(*snapshotOf(options, job, frame));
  }
  Rendered rendered{sequence.readImage(), {}};
  if (!job.idsPath.empty()) rendered.ids = sequence.renderIds(*snapshotOf(options, job, options.frame));
  return rendered;
}

// The raster's final image with traced maps: one frame, as nothing of them depends on those before.
Rendered renderOracle(const RenderOptions& options, const RenderJob& job, const GlobalOptions& globals) {
  if (!takesOracleMaps(job.technique))
    throwInputError("--with oracle wants a technique with cube maps, which lookup '{}' has none of",
                    printSpec(job.technique.lookup));
  if (job.reference.depth && *job.reference.depth < 2)
    throwInputError("--with oracle wants --depth of at least 2, one hit for the picture and one for the maps");
  const auto snapshot = snapshotOf(options, job, options.frame);
  const Technique technique = withGivenMaps(job.technique);
  const OracleMaps maps =
      traceMaps(probeViews(technique, snapshot, job.image.heightPx), job.reference, needsDistances(technique));
  RasterDevice device(globals.backend());
  Rendered rendered{renderWithMaps(device, technique, *snapshot, job.image, maps), {}};
  if (!job.idsPath.empty())
    rendered.ids =
        RasterSequence(device, job.technique, job.image.widthPx, job.image.heightPx, job.image.samplesPerAxis)
            .renderIds(*snapshot);
  return rendered;
}

Rendered renderReference(const RenderOptions& options, const RenderJob& job) {
  const ImageSettings& image = job.image;
  const auto snapshot = snapshotOf(options, job, options.frame);
  const ReferenceScene scene(snapshot);
  Rendered rendered;
  rendered.image =
      scene.render(snapshot->camera, image.widthPx, image.heightPx, job.reference, &interruptRequested()).mean();
  if (!job.idsPath.empty())
    rendered.ids = scene.renderIds(snapshot->camera, image.widthPx, image.heightPx, image.samplesPerAxis);
  return rendered;
}

void scaleByStops(Image& image, double stops) {
  const float scale = static_cast<float>(std::exp2(stops));
  for (glm::vec3& pixel : image) pixel *= scale;
}

void writeIds(const std::string& path, const Grid<SampleId>& ids) {
  // A float holds whole numbers up to 2^24 exactly.
  std::vector<NamedPlane> planes;
  for (const char* name : {"instance", "group", "texel"}) planes.push_back({name, Plane(ids.width(), ids.height())});
  for (std::size_t i = 0; i < ids.size(); ++i) {
    planes[0].plane[i] = static_cast<float>(ids[i].instance);
    planes[1].plane[i] = static_cast<float>(ids[i].group);
    planes[2].plane[i] = static_cast<float>(ids[i].texel);
  }
  writeExr(path, planes);
}

Rendered renderWith(const RenderOptions& options, const RenderJob& job, const GlobalOptions& globals) {
  if (options.renderer == "raster") return renderRaster(options, job, globals);
  if (options.renderer == "oracle") return renderOracle(options, job, globals);
  return renderReference(options, job);
}

int render(const RenderOptions& options, const GlobalOptions& globals) {
  const RenderJob job = parseJob(options);
  for (const std::string& warning : job.scene->warnings) fmt::print(stderr, "warning: {}\n", warning);
  Rendered rendered = renderWith(options, job, globals);
  scaleByStops(rendered.image, options.exposure);
  writeImage(options.output, rendered.image);
  if (!job.idsPath.empty()) writeIds(job.idsPath, rendered.ids);
  return 0;
}

}  // namespace

void addRenderCommand(CLI::App& app, const GlobalOptions& globals, Action& action) {
  CLI::App* command = app.add_subcommand("render", "one picture of a scene");
  const auto options = std::make_shared<RenderOptions>();
  command->add_option("SCENE", options->scene, "a .gltf, .glb or .obj file, or builtin:NAME, with ?key=value options")
      ->required();
  command->add_option("--with", options->renderer, "raster, reference, or oracle: the raster with traced maps")
      ->required()
      ->check(CLI::IsMember({"raster", "reference", "oracle"}));
  command->add_option("-o", options->output, "the picture: .exr or .png")->required();
  command->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--samples", options->samples, "primary samples a pixel: 1, 4, 9, ..")->capture_default_str();
  command->add_option("--camera", options->camera,
                      "name of a camera, or orbit?radius=..&height=..&period=..; the first if absent");
  command->add_option("--frame", options->frame, "frame of the animation")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command->add_option("--set", options->settings, "AXIS=VALUE of the raster; see `probebench axes list`")
      ->allow_extra_args(false);
  command->add_option("--depth", options->depth, "specular bounces of the reference")->capture_default_str();
  command->add_option("--diffuse", options->diffuse, "light on diffuse surfaces of the reference: local or traced")
      ->capture_default_str();
  command
      ->add_option("--diffuse-depth", options->diffuseDepth, "diffuse bounces of --diffuse traced; unlimited if absent")
      ->check(CLI::Range(0, 1'000));
  command->add_option("--spp", options->spp, "samples per primary sample of the reference, even")
      ->check(CLI::Validator(
          [](std::string& text) {
            const std::optional<long long> spp = parseInteger(text);
            return spp && *spp >= 2 && *spp <= 65536 && *spp % 2 == 0
                       ? std::string()
                       : fmt::format("wants an even number from 2 to 65536, got {}", text);
          },
          "EVEN"))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the reference's random numbers")
      ->check(wholeNumber())
      ->capture_default_str();
  command->add_option("--sampling", options->sampling, "random numbers of the reference: sobol or independent")
      ->check(CLI::IsMember({"sobol", "independent"}))
      ->capture_default_str();
  command->add_option("--exposure", options->exposure, "stops")->check(numberFrom(-32, 32))->capture_default_str();
  command->add_option("--aov", options->aovs, "ids=FILE.exr: what each primary sample shows")->allow_extra_args(false);
  command->callback(
      [&action, &globals, options] { action = [&globals, options] { return render(*options, globals); }; });
}

}  // namespace pb
