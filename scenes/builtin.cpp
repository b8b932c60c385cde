#include "scenes/builtin.h"

#include <algorithm>

#include "scenes/error.h"

namespace pb {

#define SCENE(name, parameters, description, make) Scene make(SpecReader&);
#include "scenes/builtin/scenes.def"
#undef SCENE

const std::vector<BuiltinScene>& builtinScenes() {
  static const std::vector<BuiltinScene> table = {
#define SCENE(name, parameters, description, make) {name, parameters, description, make},
#include "scenes/builtin/scenes.def"
#undef SCENE
  };
  return table;
}

Scene makeBuiltinScene(const Spec& spec) {
  const auto found = std::ranges::find(builtinScenes(), spec.name, &BuiltinScene::name);
  if (found == builtinScenes().end()) {
    std::vector<std::string> names;
    for (const BuiltinScene& scene : builtinScenes()) names.push_back(scene.name);
    throwInputError("built-in scene {}", unknownMessage(spec.name, names));
  }
  SpecReader parameters(spec, "scene 'builtin:" + spec.name + "'");
  Scene scene = found->make(parameters);
  parameters.finish();
  if (scene.name.empty()) scene.name = spec.name;
  finishScene(scene);
  return scene;
}

}  // namespace pb
