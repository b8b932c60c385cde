#include "scenes/builtin.h"

#include <algorithm>

#include "scenes/error.h"

namespace pb {

Scene makeControlScene(SpecReader& parameters);
Scene makeControlAlphaScene(SpecReader& parameters);
Scene makeControlShadowsScene(SpecReader& parameters);
Scene makeCrtHeapScene(SpecReader& parameters);
Scene makeDispersionScene(SpecReader& parameters);
Scene makeFlagAndHorseScene(SpecReader& parameters);
Scene makeGlassScene(SpecReader& parameters);
Scene makeGlassShapesScene(SpecReader& parameters);
Scene makeHallOfMirrorsScene(SpecReader& parameters);
Scene makeMetalsScene(SpecReader& parameters);
Scene makeMirrorCubeScene(SpecReader& parameters);
Scene makeMirrorRoomScene(SpecReader& parameters);
Scene makeMirrorsRingScene(SpecReader& parameters);
Scene makeMirrorsScene(SpecReader& parameters);
Scene makePlanarFloorScene(SpecReader& parameters);
Scene makeStreetScene(SpecReader& parameters);
Scene makeTeapotScene(SpecReader& parameters);

const std::vector<BuiltinScene>& builtinScenes() {
  static const std::vector<BuiltinScene> table = {
      {"control", "textures = 1 or 0 for plain colours and no normal maps, default 1",
       "No specular surface at all: many shapes, textures, normal maps and transforms under three lights.",
       makeControlScene},
      {"control-alpha", "", "Matte cutouts, and transparent matte surfaces that cut through each other.",
       makeControlAlphaScene},
      {"control-shadows", "textures = 1 or 0 for plain colours and no normal maps, default 1",
       "The control with shadows of a directional, a point and a spot light.", makeControlShadowsScene},
      {"crt-heap", "count = monitors, 1 to 12, default 10",
       "A heap of monitors with mirrors on their sides that show moving pictures.", makeCrtHeapScene},
      {"dispersion", "", "Prisms, an absorbing column and a faceted gem before bright slits.", makeDispersionScene},
      {"flag-and-horse", "", "A waving flag and a trotting horse that circle a mirror teapot.", makeFlagAndHorseScene},
      {"glass", "", "Glass, rough metal and mirror balls under a lamp: scene B of the CPU ray tracers' benchmark.",
       makeGlassScene},
      {"glass-shapes", "", "A cube, a ball and a bust of dispersing glass before a striped wall.",
       makeGlassShapesScene},
      {"hall-of-mirrors", "", "A corridor between two facing mirrors: many bounces.", makeHallOfMirrorsScene},
      {"metals", "grid = spheres a row, 2 to 8, default 5",
       "Silver, gold and copper spheres from perfectly smooth to very rough.", makeMetalsScene},
      {"mirror-cube", "", "A mirror cube in a room, with near objects that a cube map shows far away and large.",
       makeMirrorCubeScene},
      {"mirror-room", "count = mirror balls, 1 to 16, default 5",
       "Small mirror balls in a closed room: little parallax, many bounces.", makeMirrorRoomScene},
      {"mirrors",
       "count = mirror balls on the ring, 1 to 64, default 5; probes = how many of them, the first ones, have a probe "
       "of "
       "their own, 0 to 64, default all",
       "A ring of mirror balls that reflect each other on a checkered ground.", makeMirrorsScene},
      {"mirrors-ring", "point = 1 to add a point light, default 0",
       "Eight mirror balls on a ring under a constant sky: scene A of the CPU ray tracers' benchmark.",
       makeMirrorsRingScene},
      {"planar-floor", "", "A flat mirror as the floor of a room, with objects on it and beyond it.",
       makePlanarFloorScene},
      {"street", "", "A car of mirror-like paint and glass drives past facades.", makeStreetScene},
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
