#include "scenes/builtin.h"

#include <algorithm>

#include "scenes/error.h"

namespace pb {

Scene makeControlScene(SpecReader& parameters);
Scene makeMirrorRoomScene(SpecReader& parameters);
Scene makeMirrorsScene(SpecReader& parameters);
Scene makeTeapotScene(SpecReader& parameters);

const std::vector<BuiltinScene>& builtinScenes() {
  static const std::vector<BuiltinScene> table = {
      {"control", "textures = 1 or 0 for plain colours and no normal maps, default 1",
       "No specular surface at all: many shapes, textures, normal maps and transforms under three lights.",
       makeControlScene},
      {"mirror-room", "count = mirror balls, 1 to 16, default 5",
       "Small mirror balls in a closed room: little parallax, many bounces.", makeMirrorRoomScene},
      {"mirrors", "count = mirror balls on the ring, 1 to 64, default 5",
       "A ring of mirror balls that reflect each other on a checkered ground.", makeMirrorsScene},
      {"teapot", "", "A mirror teapot with a matte one on an orbit around it.", makeTeapotScene},
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
