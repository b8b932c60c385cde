// A first suite for somebody's scene: axes and frames follow from what the scene holds.
#pragma once

#include <string>

#include "scenes/scene.h"

namespace pb {

// What of a scene decides which settings of the approximation matter.
struct SceneTraits {
  int probes = 0;            // at frame 0
  int mirrors = 0;           // instances with a probe that reflect
  int glass = 0;             // instances with a probe that refract
  int flatMirrors = 0;       // mirrors that lie in a plane
  bool onlyFlat = false;     // every instance with a probe does
  bool roughMetals = false;  // whose reflections need filtered maps
  bool disperses = false;    // glass of which each wavelength takes its own way
  bool hasBox = false;       // the surroundings of a probe are stated as a box
  bool castsShadows = false;
  double durationSeconds = 0;  // 0: nothing moves
  double framesPerSecond = 30;
};

SceneTraits traitsOf(const std::shared_ptr<const Scene>& scene);

// The suite as commented TOML. `use` is the scene as it is to stand there: its path relative to the suite's folder.
std::string makeSuiteText(const std::string& name, const std::string& use, const SceneTraits& traits);

// The scene reference of the command line as a suite in `folder` names it: paths relative to that, files of
// environments absolute.
std::string sceneFromFolder(const std::string& reference, const std::string& folder);

}  // namespace pb
