#include "bench/store.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/hash.h"
#include "bench/suite.h"
#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/image_io.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kChannels[3] = {"R", "G", "B"};

fs::path withSuffix(fs::path path, const char* suffix) { return path += suffix; }

// "07.G": the green channel of batch 7.
std::string planeName(std::size_t batch, int channel) { return fmt::format("{:02}.{}", batch, kChannels[channel]); }

std::vector<NamedPlane> planesOf(const std::vector<Image>& batches) {
  std::vector<NamedPlane> planes;
  for (std::size_t batch = 0; batch < batches.size(); ++batch)
    for (int channel = 0; channel < 3; ++channel) {
      Plane plane(batches[batch].width(), batches[batch].height());
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = batches[batch][i][channel];
      planes.push_back({planeName(batch, channel), std::move(plane)});
    }
  return planes;
}

const Plane& planeNamed(const std::vector<NamedPlane>& planes, const std::string& name,
                        const ReferenceRequest& request) {
  for (const NamedPlane& named : planes)
    if (named.name == name && named.plane.width() == request.widthPx && named.plane.height() == request.heightPx)
      return named.plane;
  throwInputError("channel '{}' of the size asked for is missing", name);
}

std::vector<Image> batchesOf(const std::vector<NamedPlane>& planes, const ReferenceRequest& request) {
  std::vector<Image> batches(planes.size() / 3, Image(request.widthPx, request.heightPx));
  for (std::size_t batch = 0; batch < batches.size(); ++batch)
    for (int channel = 0; channel < 3; ++channel) {
      const Plane& plane = planeNamed(planes, planeName(batch, channel), request);
      for (std::size_t i = 0; i < plane.size(); ++i) batches[batch][i][channel] = plane[i];
    }
  return batches;
}

// Throws when anything is not as save() left it.
ReferenceImage readEntry(const fs::path& entry, const ReferenceRequest& request) {
  const Json record = Json::parse(readFile(withSuffix(entry, ".json").string()));
  if (record.at("request") != ReferenceStore::describe(request)) throwInputError("it belongs to another request");
  const std::string image = withSuffix(entry, ".exr").string();
  if (record.at("xxh3_128") != hexHash(readFile(image))) throwInputError("its checksum does not match");
  ReferenceImage result;
  result.batches = batchesOf(readExrChannels(image), request);
  result.raysTraced = record.at("rays_traced").get<std::int64_t>();
  if (result.batches.empty()) throwInputError("it holds no image");
  return result;
}

}  // namespace

fs::path defaultStoreFolder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/')
    return fs::path(cache) / "probebench" / "references";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return fs::path(home) / ".cache" / "probebench" / "references";
  throwEnvironmentError("there is no folder for references: neither XDG_CACHE_HOME nor HOME is set, use --store DIR");
}

std::string ReferenceStore::describe(const ReferenceRequest& request) {
  const ReferenceSettings& settings = request.settings;
  std::string text = fmt::format(
      "snapshot {:016x} size {}x{} samples {} spp {} depth {} diffuse {} {} seed {} sampling {} hidden [{}] integrator "
      "{} embree {}",
      referenceHash(*request.snapshot), request.widthPx, request.heightPx,
      settings.samplesPerAxis * settings.samplesPerAxis, settings.spp,
      settings.depth ? std::to_string(*settings.depth) : "converged", printDiffuse(settings.diffuse),
      settings.diffuseDepth ? std::to_string(*settings.diffuseDepth) : "unlimited", settings.seed,
      settings.sampling == Sampling::sobol ? "sobol" : "independent", fmt::join(settings.hiddenInstances, ","),
      kIntegratorVersion, embreeVersion());
  if (!settings.hiddenFromPrimary.empty())
    text += fmt::format(" hidden from primary rays [{}]", fmt::join(settings.hiddenFromPrimary, ","));
  if (request.refinement)
    text += fmt::format(" pass {} of max_noise {} spp at most {}", request.refinement->pass,
                        request.refinement->goal.maxNoise, request.refinement->goal.maxSpp);
  return text;
}

fs::path ReferenceStore::entry(const ReferenceRequest& request) const { return folder_ / hexHash(describe(request)); }

bool ReferenceStore::contains(const ReferenceRequest& request) const {
  std::error_code unreadable;  // the same as absent: rendering anew is always right
  return fs::exists(withSuffix(entry(request), ".json"), unreadable);
}

std::optional<ReferenceImage> ReferenceStore::load(const ReferenceRequest& request, std::string& warning) const {
  if (!contains(request)) return std::nullopt;
  const fs::path path = entry(request);
  try {
    return readEntry(path, request);
  } catch (const std::exception& error) {
    warning = fmt::format("stored reference '{}' is rendered anew: {}", path.string(), error.what());
    return std::nullopt;
  }
}

void ReferenceStore::save(const ReferenceRequest& request, const ReferenceImage& image) const {
  std::error_code failure;
  fs::create_directories(folder_, failure);
  if (failure)
    throwEnvironmentError("the reference store '{}' can't be made: {}, use --store DIR", folder_.string(),
                          failure.message());
  const fs::path path = entry(request);
  const std::string file = withSuffix(path, ".exr").string();
  writeExr(file, planesOf(image.batches));
  // The record comes last: an entry without it is not there.
  const Json record = {
      {"request", describe(request)}, {"rays_traced", image.raysTraced}, {"xxh3_128", hexHash(readFile(file))}};
  writeFileAtomically(withSuffix(path, ".json").string(), record.dump(2) + "\n");
}

}  // namespace pb
