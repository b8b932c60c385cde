#include "bench/provenance.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bench/hash.h"
#include "bench/version.h"

namespace pb {
namespace {

std::vector<std::pair<std::string, std::string>> settingsOf(const Suite& suite) {
  const ImageSettings& image = suite.image;
  const TruthSettings& reference = suite.reference;
  return {{"image", fmt::format("{}x{}", image.widthPx, image.heightPx)},
          {"samples", fmt::format("{} a pixel", image.samplesPerAxis * image.samplesPerAxis)},
          {"reference depth", reference.depth ? std::to_string(*reference.depth) : "converged"},
          {"reference diffuse", printDiffuse(reference.diffuse)},
          {"reference diffuse_depth", reference.diffuseDepth ? std::to_string(*reference.diffuseDepth) : "unlimited"},
          {"reference spp", fmt::format("{} a primary sample", reference.spp)},
          {"reference matched", reference.matched ? "yes" : "no"},
          {"reference max_noise", reference.maxNoise ? fmt::format("{:g}", *reference.maxNoise) : "none"},
          {"cost repetitions", std::to_string(suite.cost.repetitions)}};
}

// Mixes in everything that a sequence renders, so that an animation that was edited anywhere on the way is seen.
void mixContent(std::uint64_t& hash, const std::shared_ptr<const Scene>& scene, const SuiteScene& chosen,
                double aspect) {
  constexpr std::uint64_t kPrime = 0x100000001b3;  // of FNV-1a
  const bool moves = scene->durationSeconds > 0.0;
  for (int frame = moves ? std::max(chosen.startFrame(), 0) : chosen.frames.back(); frame <= chosen.frames.back();
       ++frame)
    hash = (hash * kPrime) ^ contentHash(*makeSnapshot(scene, frame, chosen.camera, aspect));
}

}  // namespace

Provenance makeProvenance(const Suite& suite, const Scenes& scenes, const GlInfo& gl, int threads) {
  Provenance provenance;
  provenance.toolVersion = toolVersion();
  provenance.gitHash = gitHash();
  provenance.suiteName = suite.name;
  provenance.suiteHash = hexHash(canonicalText(suite));
  provenance.startedAt = timestamp();
  provenance.cpu = cpuName();
  provenance.threads = threads;
  provenance.glBackend = gl.backend;
  provenance.glRenderer = gl.renderer;
  provenance.glVersion = gl.version;
  provenance.libraries = libraryVersions();
  provenance.settings = settingsOf(suite);
  provenance.seed = ReferenceSettings().seed;
  provenance.maxNoise = suite.reference.maxNoise;
  std::map<std::string, std::uint64_t> contents;  // a scene may stand there with several cameras
  for (std::size_t i = 0; i < scenes.size(); ++i)
    mixContent(contents[suite.scenes[i].name], scenes[i], suite.scenes[i], suite.image.aspect());
  for (const auto& [scene, hash] : contents) provenance.sceneHashes[scene] = fmt::format("{:016x}", hash);
  return provenance;
}

std::string fingerprint(const Provenance& provenance, const Plan& plan, const Suite& suite) {
  std::string text = fmt::format("{} {} {} {} {}\n", provenance.toolVersion, provenance.gitHash, provenance.suiteHash,
                                 provenance.glRenderer, provenance.glVersion);
  for (const auto& [scene, hash] : provenance.sceneHashes) text += fmt::format("{} {}\n", scene, hash);
  for (const PlannedSequence& sequence : plan.sequences)
    text += fmt::format("{} {}\n", makeCell(suite, sequence, 0).sequenceKey(), fmt::join(sequence.frames, ","));
  return hexHash(text);
}

}  // namespace pb
