// Planar reflections: what a flat reflector shows, drawn from the camera mirrored at its plane. Pure functions.
//
// The mirror image of a camera sees every point where the camera sees its mirror image: a fragment of the reflector
// finds what it reflects at its own place of the mirrored view. Surfaces behind the plane are clipped away.
#pragma once

#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "raster/technique.h"
#include "scenes/snapshot.h"

namespace pb {

struct MirrorPlane {
  glm::vec3 normal;  // unit
  float offset;      // dot(normal, p) of its points, metres

  float distanceTo(const glm::vec3& p) const { return glm::dot(normal, p) - offset; }
};

// The plane of an instance's triangles if they and its normals fit one, turned to the side that they face.
std::optional<MirrorPlane> planeOf(const SnapshotInstance& instance);

// Part of an instance's size within which it lies in a plane.
inline constexpr float kPlanarThickness = 1e-4f;

shading::View mirrored(const shading::View& view, const MirrorPlane& plane);

struct MirroredView {
  MirrorPlane plane;  // turned to the camera
  shading::View view;
  std::vector<int> instances;  // in that plane
};

// Of the reflectors with probes that the camera may see; none unless the technique's lookup is planar. Throws an input
// Error naming an instance that owns a probe and is not flat.
std::vector<MirroredView> mirroredViews(const Technique& technique, const Snapshot& snapshot);

// Whether anything looks up the maps of probes: not if the only reflector is a planar one through which nothing is
// seen.
bool looksUpMaps(const Technique& technique, const Snapshot& snapshot);

}  // namespace pb
