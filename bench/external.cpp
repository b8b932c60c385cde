#include "bench/external.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include "bench/child_process.h"
#include "bench/interrupt.h"
#include "bench/statistics.h"
#include "results/schema/timing.schema.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/gltf_save.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr int kJobVersion = 1;
constexpr DocumentFormat kTimingFormat{"timing", "timing_version", 1, schemas::kTiming};

// Of autotools' and others' tests: the program can't do the job here.
constexpr int kSkipped = 77;

std::string whoOf(const ExternalTechnique& technique) { return fmt::format("external technique '{}'", technique.name); }

std::string jobPicture(const std::string& folder, int frame) { return fmt::format("{}/{}.exr", folder, frame); }
std::string jobTiming(const std::string& folder) { return folder + "/timing.json"; }
std::string jobScene(const std::string& folder) { return folder + "/scene.glb"; }

Json arrayOf(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// Column by column, as glTF has them.
Json arrayOf(const glm::dmat4& m) {
  Json array = Json::array();
  for (int i = 0; i < 16; ++i) array.push_back(glm::value_ptr(m)[i]);
  return array;
}

double tangentOfHalfFov(const shading::View& view) { return glm::length(glm::dvec3(view.down)); }

// A glTF camera: +X right, +Y up, looking down -Z.
glm::dmat4 worldFromCamera(const shading::View& view) {
  return {glm::dvec4(glm::normalize(glm::dvec3(view.right)), 0.0),
          glm::dvec4(-glm::normalize(glm::dvec3(view.down)), 0.0), glm::dvec4(-glm::dvec3(view.forward), 0.0),
          glm::dvec4(glm::dvec3(view.origin), 1.0)};
}

// glTF 2.0, 3.10.3.3: infinite projection; OpenGL's clip space.
glm::dmat4 clipFromCamera(const shading::View& view) {
  const double tangent = tangentOfHalfFov(view), near = static_cast<double>(view.origin.w);
  glm::dmat4 m(0.0);
  m[0][0] = 1.0 / glm::length(glm::dvec3(view.right));
  m[1][1] = 1.0 / tangent;
  m[2][2] = -1.0;
  m[2][3] = -1.0;
  m[3][2] = -2.0 * near;
  return m;
}

Json cameraJson(const ExternalRequest& request) {
  const shading::View& view = request.frames.front().snapshot->camera;
  return {{"name", request.name.camera},
          {"vertical_fov", 2.0 * std::atan(tangentOfHalfFov(view))},
          {"z_near", view.origin.w},
          {"clip_from_camera", arrayOf(clipFromCamera(view))}};
}

// Where the instance stands in the file: saveGlb() makes the instances of a node the primitives of its mesh.
Json ownerJson(const Scene& scene, std::size_t instance) {
  const int node = scene.instances[instance].node;
  const auto primitive =
      std::count_if(scene.instances.begin(), scene.instances.begin() + static_cast<std::ptrdiff_t>(instance),
                    [&](const Instance& other) { return other.node == node; });
  return {{"node", node}, {"name", scene.nodes[static_cast<std::size_t>(node)].name}, {"primitive", primitive}};
}

Json probesJson(const Snapshot& snapshot) {
  Json probes = Json::array();
  for (const Probe& probe : snapshot.probes) {
    Json owners = Json::array();
    for (const int owner : probe.owners) owners.push_back(ownerJson(*snapshot.scene, static_cast<std::size_t>(owner)));
    probes.push_back({{"position", arrayOf(probe.position)}, {"z_near", probe.zNear}, {"owners", std::move(owners)}});
  }
  return probes;
}

Json frameJson(const ExternalFrame& frame, const std::string& folder) {
  const glm::dmat4 world = worldFromCamera(frame.snapshot->camera);
  return {{"frame", frame.frame},
          {"time_s", frame.snapshot->timeSeconds},
          {"world_from_camera", arrayOf(world)},
          {"camera_from_world", arrayOf(glm::inverse(world))},
          {"probes", probesJson(*frame.snapshot)},
          {"image", frame.isMeasured ? Json(jobPicture(folder, frame.frame)) : Json()}};
}

Json axesJson(const AxisValues& axes) {
  Json json = Json::object();
  for (const auto& [axis, value] : axes) json[axis] = value;
  return json;
}

// One line without control characters, its end cut off where it is long.
std::string oneLine(const std::string& text) {
  constexpr std::size_t kMaxLength = 200;
  std::string line;
  for (const char c : text.substr(0, kMaxLength)) line += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  return text.size() > kMaxLength ? line + "..." : line;
}

// Of several lines the last that says something: what made the program give up.
std::string lastLine(const std::string& words) {
  const std::size_t end = words.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return {};
  const std::size_t before = words.find_last_of('\n', end);
  return oneLine(words.substr(before == std::string::npos ? 0 : before + 1, end - (before + 1) + 1));
}

// ": why", or nothing.
std::string reasonText(const std::string& words) {
  const std::string line = lastLine(words);
  return line.empty() ? "" : ": " + line;
}

// Throws for everything but a program that did its work or skipped it.
void requireEnd(const ExternalTechnique& technique, const ChildResult& result) {
  using End = ChildResult::End;
  const std::string who = whoOf(technique);
  switch (result.end) {
    case End::stopped:
      throw Error(Failure::interrupted, "interrupted");
    case End::timedOut:
      throwInputError("{} may take {} s (timeout_s) and was stopped after them{}", who, technique.timeoutS,
                      reasonText(result.lastWords));
    case End::killedBySignal:
      throwInputError("{} was ended by signal {}{}", who, result.code, reasonText(result.lastWords));
    case End::exited:
      if (result.code != 0 && result.code != kSkipped)
        throwInputError("{} failed with exit code {}{}", who, result.code, reasonText(result.lastWords));
  }
}

void takePictures(const ExternalRequest& request, const std::function<std::string(int frame)>& fileOf,
                  const std::optional<ReportedCost>& cost, const TakePicture& take) {
  for (const ExternalFrame& frame : request.frames)
    if (frame.isMeasured)
      take(frame.frame, readPicture(fileOf(frame.frame), request.image, whoOf(request.technique)), cost);
}

ExternalOutcome runCommand(const ExternalRequest& request, const TakePicture& take) {
  const ExternalTechnique& technique = request.technique;
  const TemporaryFolder temporary;
  const std::string folder = temporary.path().string();
  saveGlb(*request.frames.front().snapshot->scene, jobScene(folder));
  const std::string job = temporary.file("job.json");
  writeFileAtomically(job, makeJob(request, folder).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");

  std::vector<std::string> command = technique.command;
  command.front() = findProgram(command.front(), whoOf(technique));
  command.push_back(job);
  const ChildResult result = runChild(command, folder, std::chrono::seconds(technique.timeoutS), interruptRequested());
  requireEnd(technique, result);
  if (result.code == kSkipped) {
    const std::string reason = lastLine(result.lastWords);
    return {reason.empty() ? "it gave no reason" : reason, {}};
  }
  std::optional<ReportedCost> cost;
  if (request.repetitions > 0 && fs::exists(jobTiming(folder))) cost = readTiming(jobTiming(folder));
  takePictures(
      request, [&](int frame) { return jobPicture(folder, frame); }, cost, take);
  return {std::nullopt, lastLine(result.lastWords)};
}

std::string fileOfFrame(const std::string& pattern, PictureName name, int frame) {
  name.frame = frame;
  return pictureFile(pattern, name);
}

ExternalOutcome readEarlier(const ExternalRequest& request, const TakePicture& take) {
  const ExternalTechnique& technique = request.technique;
  std::optional<ReportedCost> cost;
  if (request.repetitions > 0 && !technique.timing.empty())
    cost = readTiming(fileOfFrame(technique.timing, request.name, 0));
  takePictures(
      request, [&](int frame) { return fileOfFrame(technique.images, request.name, frame); }, cost, take);
  return {};
}

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void requireFinite(const Image& picture, const std::string& path, const std::string& who) {
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      if (const glm::vec3& p = picture(x, y); !isFinite(p))
        throwInputError("pictures want finite values, pixel ({}, {}) of '{}' of {} is ({:g}, {:g}, {:g})", x, y, path,
                        who, p.x, p.y, p.z);
}

}  // namespace

Json makeJob(const ExternalRequest& request, const std::string& folder) {
  Json frames = Json::array();
  for (const ExternalFrame& frame : request.frames) frames.push_back(frameJson(frame, folder));
  const int s = request.image.samplesPerAxis;
  Json job = {{"job_version", kJobVersion},
              {"technique",
               {{"name", request.technique.name},
                {"settings", Json::parse(request.technique.settings)},
                {"axes", axesJson(request.axes)}}},
              {"scene", {{"name", request.name.scene}, {"file", jobScene(folder)}}},
              {"image", {{"width", request.image.widthPx}, {"height", request.image.heightPx}, {"samples", s * s}}},
              {"camera", cameraJson(request)},
              {"frames", std::move(frames)},
              {"timing", nullptr}};
  if (request.repetitions > 0) job["timing"] = {{"file", jobTiming(folder)}, {"repetitions", request.repetitions}};
  return job;
}

ReportedCost readTiming(const std::string& path) {
  const Json timing = parseDocument(readFile(path), path, kTimingFormat);
  ReportedCost cost;
  cost.program = timing.at("program").get<std::string>();
  const auto frames = timing.at("frame_ms").get<std::vector<double>>();
  const MedianInterval interval = medianInterval(frames);
  cost.frames = static_cast<int>(frames.size());
  cost.frameMs = interval.median;
  cost.frameMsLow = interval.low;
  cost.frameMsHigh = interval.high;
  if (const auto plain = timing.find("plain_ms"); plain != timing.end())
    cost.plainMs = median(plain->get<std::vector<double>>());
  return cost;
}

Image readPicture(const std::string& path, const ImageSettings& image, const std::string& who) {
  if (!fs::is_regular_file(path)) throwInputError("{} has no picture '{}'", who, path);
  const LoadedImage loaded = readImage(path);
  if (loaded.encoding != Encoding::linear)
    throwInputError("{} wants pictures of linear float values (EXR), '{}' has integers", who, path);
  Image picture = rgbOf(loaded.pixels);
  if (picture.width() != image.widthPx || picture.height() != image.heightPx)
    throwInputError("{} was to render {}x{} pixels, '{}' has {}x{}", who, image.widthPx, image.heightPx, path,
                    picture.width(), picture.height());
  requireFinite(picture, path, who);
  return picture;
}

void requireAvailable(const ExternalTechnique& technique, const PictureName& name, const std::vector<int>& frames) {
  if (!technique.command.empty()) {
    findProgram(technique.command.front(), whoOf(technique));
    return;
  }
  for (const int frame : frames)
    if (const std::string file = fileOfFrame(technique.images, name, frame); !fs::is_regular_file(file))
      throwInputError("{} has no picture '{}'", whoOf(technique), file);
}

ExternalOutcome runExternal(const ExternalRequest& request, const TakePicture& take) {
  return request.technique.command.empty() ? readEarlier(request, take) : runCommand(request, take);
}

}  // namespace pb
