#include "bench/object_errors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>

namespace pb {
namespace {

constexpr int kEnvironment = -1;

std::size_t indexOf(int i) { return static_cast<std::size_t>(i); }

const std::string& nameOf(const Snapshot& snapshot, const SnapshotInstance& instance) {
  return snapshot.scene->instances[indexOf(instance.source)].name;
}

// Probes of the parts of each of the snapshot's instances.
std::vector<std::vector<int>> probesOf(const Snapshot& snapshot, const Snapshot& laidOut) {
  std::map<int, std::vector<int>> bySource;
  for (const SnapshotInstance& part : laidOut.instances)
    if (part.probe >= 0) bySource[part.source].push_back(part.probe);
  std::vector<std::vector<int>> probes;
  for (const SnapshotInstance& instance : snapshot.instances) probes.push_back(bySource[instance.source]);
  return probes;
}

double distanceToNearest(const Snapshot& laidOut, const std::vector<int>& probes, const glm::vec3& position) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const int probe : probes)
    nearest =
        std::min(nearest, glm::distance(glm::dvec3(laidOut.probes[indexOf(probe)].position), glm::dvec3(position)));
  return nearest;
}

struct ObjectSums {
  RegionSums errors;
  double distance = 0;
  std::int64_t distances = 0;
};

// Instances in sight and what they sum up to; the environment's entry is the last.
class Summation {
 public:
  Summation(const Snapshot& snapshot, const Snapshot& laidOut)
      : laidOut_(laidOut), probes_(probesOf(snapshot, laidOut)), objects_(snapshot.instances.size() + 1) {}

  void addErrors(int inReference, int inRaster, const glm::vec3& reference, const glm::vec3& test, float flipHdr) {
    image_.add(reference, test, flipHdr);
    // The environment is what is seen where nothing else is.
    if (inReference != kEnvironment || inRaster == kEnvironment)
      entry(inReference).errors.add(reference, test, flipHdr);
    if (inRaster != inReference && inRaster != kEnvironment) entry(inRaster).errors.add(reference, test, flipHdr);
  }

  void addDistance(int instance, const glm::vec3& position) {
    if (instance == kEnvironment || probes_[indexOf(instance)].empty()) return;
    entry(instance).distance += distanceToNearest(laidOut_, probes_[indexOf(instance)], position);
    ++entry(instance).distances;
  }

  // Sets what is known without the object's name and material.
  std::optional<ObjectError> object(std::size_t entry) const {
    const ObjectSums& sums = objects_[entry];
    if (sums.errors.pixels() == 0) return std::nullopt;
    ObjectError object{sums.errors.errors(image_.squares()), {}, {}, {}, {}, 0.0};
    if (entry < probes_.size() && !probes_[entry].empty()) object.probe = probes_[entry].front();
    if (sums.distances > 0) object.probeDistance = sums.distance / static_cast<double>(sums.distances);
    return object;
  }

 private:
  ObjectSums& entry(int instance) { return instance == kEnvironment ? objects_.back() : objects_[indexOf(instance)]; }

  const Snapshot& laidOut_;
  std::vector<std::vector<int>> probes_;  // by instance
  std::vector<ObjectSums> objects_;
  RegionSums image_;
};

}  // namespace

std::vector<std::string> objectNames(const Snapshot& snapshot) {
  std::map<std::pair<std::string, int>, int> counts;
  std::vector<std::string> names;
  for (const SnapshotInstance& instance : snapshot.instances) {
    const std::string& name = nameOf(snapshot, instance);
    const int number = ++counts[{name, instance.material}];
    names.push_back(number == 1 ? name : fmt::format("{} ({})", name, number));
  }
  return names;
}

std::vector<ObjectError> computeObjectErrors(const Snapshot& snapshot, const Snapshot& laidOut, const ObjectMap& shown,
                                             const Image& reference, const Image& test, const Plane& flipHdrMap) {
  assert(shown.inReference.size() == reference.size() && shown.inRaster.size() == reference.size());
  assert(test.size() == reference.size() && flipHdrMap.size() == reference.size());
  Summation sums(snapshot, laidOut);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    sums.addErrors(shown.inReference[i], shown.inRaster[i], reference[i], test[i], flipHdrMap[i]);
    sums.addDistance(shown.atCentre[i], shown.positions[i]);
  }
  const std::vector<std::string> names = objectNames(snapshot);
  std::vector<ObjectError> objects;
  for (std::size_t entry = 0; entry <= names.size(); ++entry) {
    std::optional<ObjectError> object = sums.object(entry);
    if (!object) continue;
    object->object = entry < names.size() ? names[entry] : "environment";
    if (entry < names.size()) {
      const Material& material = snapshot.materialOf(snapshot.instances[entry]);
      object->material = material.name;
      object->roughness = static_cast<double>(material.constants.factors.y);
    }
    objects.push_back(std::move(*object));
  }
  return objects;
}

}  // namespace pb
