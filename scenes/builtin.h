// Scenes made by code. Adding one: a file in scenes/builtin/ and its line in scenes/builtin/scenes.def.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenes/scene.h"
#include "scenes/spec.h"

namespace pb {

struct BuiltinScene {
  std::string name;
  std::string parameters;   // "count = mirrors on the ring, 1 to 64, default 5"; "" for none
  std::string description;  // one sentence
  Scene (*make)(SpecReader& parameters);
};

const std::vector<BuiltinScene>& builtinScenes();

// `spec.name` without "builtin:"; the parameter `environment` is left to the caller. Throws an input Error for an
// unknown scene or parameter. The result went through finishScene().
Scene makeBuiltinScene(const Spec& spec);

}  // namespace pb
