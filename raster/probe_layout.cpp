#include "raster/probe_layout.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

#include "scenes/error.h"
#include "scenes/mesh_parts.h"

namespace pb {
namespace {

struct Sharing {
  double metres = -1.0;                                         // clusters nearer to each other than this are joined
  std::size_t count = std::numeric_limits<std::size_t>::max();  // and the nearest ones, until no more are left
};

Sharing sharingOf(const Spec& spec) {
  SpecReader reader(spec, "sharing '" + printSpec(spec) + "'");
  Sharing sharing;
  if (spec.name == "distance")
    sharing.metres = reader.number("metres", 0.0, 1e9, 1.0);
  else if (spec.name == "count")
    sharing.count = static_cast<std::size_t>(reader.integer("probes", 1, 1000, 1));
  else if (spec.name != "none")
    throwInputError("sharing {}", unknownMessage(spec.name, std::vector<std::string>{"none", "distance", "count"}));
  reader.finish();
  return sharing;
}

Bounds boundsOf(const Snapshot& snapshot, const Probe& probe) {
  Bounds bounds;
  for (const int owner : probe.owners) bounds.include(snapshot.instances[static_cast<std::size_t>(owner)].worldBounds);
  return bounds;
}

// Of the surfaces of all owners.
glm::vec3 centroidOf(const Snapshot& snapshot, const Probe& probe) {
  glm::dvec3 sum(0.0);
  double area = 0.0;
  for (const int owner : probe.owners) {
    const SnapshotInstance& instance = snapshot.instances[static_cast<std::size_t>(owner)];
    const Mesh& mesh = *instance.mesh;
    const auto corner = [&](std::size_t i) {
      return glm::dvec3(instance.worldFromObject * glm::vec4(mesh.positions[mesh.indices[i]], 1.0f));
    };
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::dvec3 a = corner(i), b = corner(i + 1), c = corner(i + 2);
      const double weight = glm::length(glm::cross(b - a, c - a));
      sum += weight * (a + b + c) / 3.0;
      area += weight;
    }
  }
  return area > 0.0 ? glm::vec3(sum / area) : boundsOf(snapshot, probe).centre();
}

glm::vec3 positionOf(const Snapshot& snapshot, const Probe& probe, Placement placement) {
  switch (placement) {
    case Placement::stated:
      return probe.position;
    case Placement::origin:
      return glm::vec3(snapshot.instances[static_cast<std::size_t>(probe.owners.front())].worldFromObject *
                       glm::vec4(0, 0, 0, 1));
    case Placement::boxCentre:
      return boundsOf(snapshot, probe).centre();
    case Placement::centroid:
      return centroidOf(snapshot, probe);
  }
  return probe.position;
}

// Probes that become one, with the mean of their positions.
struct Cluster {
  std::vector<std::size_t> members;
  glm::vec3 centre;
};

Cluster joined(const Cluster& a, const Cluster& b) {
  const float sizeA = static_cast<float>(a.members.size()), sizeB = static_cast<float>(b.members.size());
  Cluster both{a.members, (sizeA * a.centre + sizeB * b.centre) / (sizeA + sizeB)};
  both.members.insert(both.members.end(), b.members.begin(), b.members.end());
  return both;
}

// Agglomerative, by the distance between centres; of equal distances the first pair.
std::vector<Cluster> clustersOf(const std::vector<Probe>& probes, const Sharing& sharing) {
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < probes.size(); ++i) clusters.push_back({{i}, probes[i].position});
  while (clusters.size() > 1) {
    std::size_t first = 0, second = 1;
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < clusters.size(); ++i)
      for (std::size_t k = i + 1; k < clusters.size(); ++k)
        if (const float d = glm::distance(clusters[i].centre, clusters[k].centre); d < nearest)
          std::tie(nearest, first, second) = std::tuple(d, i, k);
    if (clusters.size() <= sharing.count && static_cast<double>(nearest) > sharing.metres) break;
    clusters[first] = joined(clusters[first], clusters[second]);
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(second));
  }
  return clusters;
}

void shareProbes(Snapshot& snapshot, const Sharing& sharing) {
  std::vector<Probe> shared;
  for (const Cluster& cluster : clustersOf(snapshot.probes, sharing)) {
    Probe& probe = shared.emplace_back(snapshot.probes[cluster.members.front()]);
    probe.position = cluster.centre;
    probe.owners.clear();
    for (const std::size_t member : cluster.members) {
      const Probe& joinedProbe = snapshot.probes[member];
      probe.owners.insert(probe.owners.end(), joinedProbe.owners.begin(), joinedProbe.owners.end());
      probe.zNear = std::min(probe.zNear, joinedProbe.zNear);
    }
    for (const int owner : probe.owners)
      snapshot.instances[static_cast<std::size_t>(owner)].probe = static_cast<int>(shared.size()) - 1;
  }
  snapshot.probes = std::move(shared);
}

}  // namespace

void checkSharing(const Spec& sharing) { sharingOf(sharing); }

ProbeLayout::ProbeLayout(const Technique& technique) : technique_(technique) { checkSharing(technique.sharing); }

const Snapshot& ProbeLayout::apply(const Snapshot& snapshot) {
  const bool splits = technique_.selfReflection == SelfReflection::splitParts;
  const bool moves = technique_.placement != Placement::stated;
  const bool shares = technique_.sharing.name != "none";
  if (snapshot.probes.empty() || !(splits || moves || shares)) return snapshot;
  laidOut_ = snapshot;
  if (splits) splitOwners(*laidOut_);
  for (Probe& probe : laidOut_->probes) probe.position = positionOf(*laidOut_, probe, technique_.placement);
  if (shares) shareProbes(*laidOut_, sharingOf(technique_.sharing));
  findNearestProbes(*laidOut_);
  return *laidOut_;
}

// Meshes that deform stay whole: what is cut is uploaded once.
std::vector<std::shared_ptr<const Mesh>> ProbeLayout::partsOf(const std::shared_ptr<const Mesh>& mesh) {
  if (mesh->isDeformed) return {mesh};
  auto& parts = parts_[mesh];
  if (parts.empty()) parts = connectedParts(mesh, kMaxParts);
  return parts;
}

// Each part becomes an instance with a probe at the centre of its box; the others see it in their captures.
void ProbeLayout::splitOwners(Snapshot& snapshot) {
  std::vector<SnapshotInstance> instances;
  std::vector<Probe> probes;
  for (const SnapshotInstance& whole : snapshot.instances) {
    if (whole.probe < 0) {
      instances.push_back(whole);
      continue;
    }
    const std::vector<std::shared_ptr<const Mesh>> parts = partsOf(whole.mesh);
    for (const std::shared_ptr<const Mesh>& part : parts) {
      SnapshotInstance instance = whole;
      Probe& probe = probes.emplace_back(snapshot.probes[static_cast<std::size_t>(whole.probe)]);
      instance.mesh = part;
      instance.worldBounds = transformed(part->bounds, whole.worldFromObject);
      instance.probe = static_cast<int>(probes.size()) - 1;
      probe.owners = {static_cast<int>(instances.size())};
      if (parts.size() > 1) probe.position = instance.worldBounds.centre();
      instances.push_back(std::move(instance));
    }
  }
  snapshot.instances = std::move(instances);
  snapshot.probes = std::move(probes);
}

}  // namespace pb
