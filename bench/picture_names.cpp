#include "bench/picture_names.h"

#include <fmt/format.h>

#include "bench/axes.h"

namespace pb {
namespace {

// Letters, digits and a few signs stay; anything else would be a surprise in a file name.
std::string fileName(std::string text) {
  for (char& c : text)
    if (std::string_view("/\\:?&*\"'<>| \t\n").find(c) != std::string_view::npos) c = '_';
  return text;
}

}  // namespace

std::string PictureNames::ofFrame(const PlannedSequence& sequence, int frame) const {
  const std::string name = prefix(sequence.scene, frame);
  if (sequence.external) return fmt::format("{}-{}={}", name, kExternalAxis, suite_.externals[*sequence.external].name);
  return name + ofTechnique(sequence);
}

std::string PictureNames::ofReference(std::size_t scene, int frame) const {
  return prefix(scene, frame) + "-reference.exr";
}

PictureName PictureNames::external(std::size_t scene) const {
  return {scenes_[scene]->name, suite_.scenes[scene].camera, scene, 0};
}

// The scene's number keeps scenes of one name apart.
std::string PictureNames::prefix(std::size_t scene, int frame) const {
  constexpr std::size_t kMaxLength = 60;  // file names have at most 255 bytes, the axes come behind
  return fmt::format("{}-{}-frame{}", scene, fileName(scenes_[scene]->name.substr(0, kMaxLength)), frame);
}

// The grid's axes, and what the scene varies.
std::string PictureNames::ofTechnique(const PlannedSequence& sequence) const {
  std::string name;
  const auto append = [&](const Axis& axis) {
    name += fmt::format("-{}={}", axis.name, fileName(axis.print(sequence.technique)));
  };
  for (const auto& [axis, values] : suite_.grid) append(axisNamed(axis));
  for (const std::string& varied : variedAxes(suite_.scenes[sequence.scene].vary))
    if (const Axis& axis = axisNamed(varied); axis.print(sequence.technique) != axis.print(suite_.technique))
      append(axis);
  return name;
}

}  // namespace pb
