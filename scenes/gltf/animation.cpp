#include "scenes/gltf/animation.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "scenes/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/node.h"

namespace pb::gltf {
namespace {

// A rotation that is not a unit quaternion can't be interpolated on the sphere; tangents of splines may be anything.
void checkRotationKeys(const Track& track) {
  const bool spline = track.interpolation == Interpolation::cubicSpline;
  for (std::size_t i = spline ? 1 : 0; i < track.values.size(); i += spline ? 3 : 1) unitQuaternion(track.values[i]);
}

Interpolation interpolationOf(const std::string& name) {
  static const std::map<std::string, Interpolation> kInterpolations = {
      {"STEP", Interpolation::step}, {"LINEAR", Interpolation::linear}, {"CUBICSPLINE", Interpolation::cubicSpline}};
  const auto found = kInterpolations.find(name);
  if (found == kInterpolations.end())
    throwInputError("interpolations are STEP, LINEAR and CUBICSPLINE, got '{}'", name);
  return found->second;
}

Track readTrack(const Document& document, const tinygltf::AnimationSampler& sampler, TrackTarget target) {
  Track track;
  track.target = target;
  track.interpolation = interpolationOf(sampler.interpolation);
  const FloatAccessor times = readFloats(document, sampler.input);
  FloatAccessor values = readFloats(document, sampler.output);
  const int wanted = target == TrackTarget::morphWeights ? 1 : target == TrackTarget::rotation ? 4 : 3;
  if (times.components != 1 || values.components != wanted)
    throwInputError("key times have 1 and values {} components, got {} and {}", wanted, times.components,
                    values.components);
  for (const glm::vec4& t : times.elements) track.timesSeconds.push_back(t.x);
  if (target == TrackTarget::morphWeights) {
    for (const glm::vec4& w : values.elements) track.weights.push_back(w.x);
    return track;
  }
  track.values = std::move(values.elements);
  if (target == TrackTarget::rotation) checkRotationKeys(track);
  return track;
}

bool hasMorphTargets(const tinygltf::Model& model, std::size_t node) {
  const int mesh = model.nodes[node].mesh;
  return mesh >= 0 && std::ranges::any_of(model.meshes[static_cast<std::size_t>(mesh)].primitives,
                                          [](const tinygltf::Primitive& p) { return !p.targets.empty(); });
}

class TrackReader {
 public:
  TrackReader(const Document& document, std::span<const int> sceneNodes, std::vector<std::string>& warnings)
      : document_(document), sceneNodes_(sceneNodes), warnings_(warnings) {}

  void read(const tinygltf::Animation& animation, const std::string& place) {
    for (const tinygltf::AnimationChannel& channel : animation.channels)
      atPlace(place, [&] { readChannel(animation, channel, place); });
  }

  std::vector<Track> tracks;

 private:
  void readChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                   const std::string& place) {
    static const std::map<std::string, TrackTarget> kTargets = {{"translation", TrackTarget::translation},
                                                                {"rotation", TrackTarget::rotation},
                                                                {"scale", TrackTarget::scale},
                                                                {"weights", TrackTarget::morphWeights}};
    const auto n = static_cast<std::size_t>(channel.target_node);
    if (sceneNodes_[n] < 0) return;
    const std::string property = fmt::format("{} of {}", channel.target_path, placeOfNode(document_, n));
    const auto target = kTargets.find(channel.target_path);
    if (target == kTargets.end()) return warnings_.push_back(fmt::format("{}: {} is not animated", place, property));
    if (target->second == TrackTarget::morphWeights && !hasMorphTargets(document_.model, n))
      return warnings_.push_back(fmt::format("{}: {} is ignored, its mesh has no morph targets", place, property));
    if (target->second != TrackTarget::morphWeights && !document_.model.nodes[n].matrix.empty())
      throwInputError("an animated node has no matrix, {} has one", placeOfNode(document_, n));
    if (!animated_.insert({n, target->second}).second)
      return warnings_.push_back(fmt::format("{}: {} is ignored, it is animated twice", place, property));
    Track track = atPlace(property, [&] {
      return readTrack(document_, animation.samplers[static_cast<std::size_t>(channel.sampler)], target->second);
    });
    track.node = sceneNodes_[n];
    tracks.push_back(std::move(track));
  }

  const Document& document_;
  std::span<const int> sceneNodes_;
  std::vector<std::string>& warnings_;
  std::set<std::pair<std::size_t, TrackTarget>> animated_;
};

}  // namespace

std::vector<Track> readTracks(const Document& document, std::span<const int> sceneNodes,
                              std::vector<std::string>& warnings) {
  TrackReader reader(document, sceneNodes, warnings);
  for (std::size_t a = 0; a < document.model.animations.size(); ++a) {
    const tinygltf::Animation& animation = document.model.animations[a];
    reader.read(animation, "animation " + label(animation.name, a));
  }
  return std::move(reader.tracks);
}

}  // namespace pb::gltf
