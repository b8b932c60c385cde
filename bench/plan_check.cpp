#include "bench/plan_check.h"

#include <algorithm>
#include <set>

#include "bench/attribution_runner.h"
#include "bench/external.h"
#include "bench/picture_names.h"
#include "raster/lookup.h"
#include "scenes/error.h"

namespace pb {
namespace {

// Whether a later frame may be refused of which the first one isn't: reflectors bend, probes part.
bool isRefusedLater(const Technique& technique) {
  return lookupOf(technique.lookup).isPlanar || technique.sharing.name == "distance";
}

void checkScene(const Suite& suite, const Scenes& scenes, const Plan& plan, std::size_t index, RasterDevice& device) {
  const SuiteScene& scene = suite.scenes[index];
  std::vector<const PlannedSequence*> left;
  for (const PlannedSequence& sequence : plan.sequences)
    if (sequence.scene == index && !sequence.external) left.push_back(&sequence);
  for (int frame = scene.startFrame(); !left.empty(); ++frame) {
    const auto snapshot = makeSnapshot(scenes[index], std::max(frame, 0), scene.camera, suite.image.aspect());
    for (const PlannedSequence* sequence : left)
      RasterSequence::check(device, sequence->technique, *snapshot, suite.image.widthPx, suite.image.heightPx,
                            suite.image.samplesPerAxis);
    std::erase_if(left, [&](const PlannedSequence* sequence) {
      return frame >= sequence->frames.back() || !isRefusedLater(sequence->technique);
    });
  }
}

// Pictures that were made earlier are of one scene and frame each.
void checkPicturesMadeEarlier(const Suite& suite, const Scenes& scenes, const Plan& plan) {
  std::set<std::pair<std::size_t, std::string>> files;  // by technique
  for (const PlannedSequence& sequence : plan.sequences) {
    if (!sequence.external || suite.externals[*sequence.external].images.empty()) continue;
    const ExternalTechnique& technique = suite.externals[*sequence.external];
    PictureName name = PictureNames(suite, scenes).external(sequence.scene);
    for (const int frame : sequence.frames) {
      name.frame = frame;
      const std::string file = pictureFile(technique.images, name);
      if (!files.emplace(*sequence.external, file).second)
        throwInputError(
            "external technique '{}' has '{}' for more than one scene or frame, of which its 'images' want a picture "
            "each",
            technique.name, file);
    }
  }
}

}  // namespace

void checkPlan(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device) {
  checkPicturesMadeEarlier(suite, scenes, plan);
  for (std::size_t scene = 0; scene < suite.scenes.size(); ++scene) checkScene(suite, scenes, plan, scene, device);
  checkAttribution(suite, scenes, plan, device);
}

void requireExternals(const Suite& suite, const Scenes& scenes, const Plan& plan) {
  const PictureNames names(suite, scenes);
  for (const PlannedSequence& sequence : plan.sequences)
    if (sequence.external)
      requireAvailable(suite.externals[*sequence.external], names.external(sequence.scene), sequence.frames);
}

}  // namespace pb
