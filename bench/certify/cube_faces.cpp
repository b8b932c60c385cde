// Orientation of the six faces and continuity across the 12 edges, in both renderers.
//
// The room is the cube [-1,1]^3 seen from inside, its walls unlit and coloured 0.5 + 0.5 * position. A probe at the
// origin must find in direction d the colour of the point d / max(|d|).
#include <cmath>

#include "bench/certify.h"
#include "bench/certify/common.h"

namespace pb {
namespace {

constexpr int kResolution = 64;

// Directions of the texel coordinates, transcribed from OpenGL 4.5 core, table 8.19, and kept apart from
// scenes/shading/cubemap.glsl, which this checks: for face +X, sc = -rz and tc = -ry, so that r = (1, -tc, -sc), and so
// on.
glm::dvec3 specifiedDirection(int face, double sc, double tc) {
  switch (face) {
    case 0:
      return {1.0, -tc, -sc};
    case 1:
      return {-1.0, -tc, sc};
    case 2:
      return {sc, 1.0, tc};
    case 3:
      return {sc, -1.0, -tc};
    case 4:
      return {sc, -tc, 1.0};
    default:
      return {-sc, -tc, -1.0};
  }
}

glm::dvec3 roomColor(glm::dvec3 d) {
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  return 0.5 + 0.5 * d / largest;
}

Scene makeRoom() {
  Scene scene;
  Material wall = makeDiffuseMaterial("Wall", glm::vec3(1.0f));
  wall.constants.kind.x = shading::kSurfaceUnlit;
  const int wallMaterial = addMaterial(scene, std::move(wall));
  // Quads that face the origin: cross(u, v) points inwards.
  struct Wall {
    glm::vec3 p, u, v;
  };
  const std::array<Wall, 6> walls = {{{{1, -1, -1}, {0, 0, 2}, {0, 2, 0}},
                                      {{-1, -1, 1}, {0, 0, -2}, {0, 2, 0}},
                                      {{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}},
                                      {{-1, -1, 1}, {2, 0, 0}, {0, 0, -2}},
                                      {{1, -1, 1}, {-2, 0, 0}, {0, 2, 0}},
                                      {{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}}};
  for (const Wall& w : walls) {
    Mesh mesh = makeQuadMesh(w.p, w.u, w.v);
    for (const glm::vec3& p : mesh.positions) mesh.colors.emplace_back(0.5f * p + 0.5f, 1.0f);
    addInstance(scene, "Wall", finishMesh(std::move(mesh)), wallMaterial);
  }
  addInstance(scene, "Probe", finishMesh(makeSphereMesh(0.1f, 16, 8)),
              addMaterial(scene, makeMirrorMaterial("Mirror")));
  scene.environment = makeConstantEnvironment(glm::vec3(0.0f));
  return scene;
}

double largestTexelError(const std::array<Image, 6>& faces) {
  double largest = 0.0;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < kResolution; ++y)
      for (int x = 0; x < kResolution; ++x) {
        const double sc = (2.0 * x + 1.0) / kResolution - 1.0, tc = (2.0 * y + 1.0) / kResolution - 1.0;
        largest = std::max(largest, maxDifference(faces[static_cast<std::size_t>(face)](x, y),
                                                  glm::vec3(roomColor(specifiedDirection(face, sc, tc)))));
      }
  return largest;
}

// Along each edge of the cube: two components are +-1, the third runs.
double largestEdgeError(const std::array<Image, 6>& faces) {
  const std::vector<ImageRgba> layers = rgbaFaces(faces);
  double largest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (int edge = 0; edge < 4; ++edge)
      for (int step = -15; step <= 15; ++step) {
        glm::vec3 d;
        d[axis] = static_cast<float>(step) / 16.0f;
        d[(axis + 1) % 3] = (edge & 1) != 0 ? 1.0f : -1.0f;
        d[(axis + 2) % 3] = (edge & 2) != 0 ? 1.0f : -1.0f;
        const glm::vec3 found(shading::sampleCube({&layers}, d));
        largest = std::max(largest, maxDifference(found, glm::vec3(roomColor(d))));
      }
  return largest;
}

std::array<Image, 6> traceFaces(const std::shared_ptr<const Snapshot>& snapshot) {
  const Probe& probe = snapshot->probes.front();
  const ReferenceScene reference(snapshot);
  ReferenceSettings settings;
  settings.samplesPerAxis = 1;
  settings.spp = 2;
  settings.hiddenInstances = probe.owners;
  std::array<Image, 6> faces;
  for (int face = 0; face < 6; ++face)
    faces[static_cast<std::size_t>(face)] =
        reference.render(cubeFaceView(probe.position, face, probe.zNear), kResolution, kResolution, settings).mean();
  return faces;
}

}  // namespace

std::vector<Check> certifyCubeFaces(RasterDevice& device) {
  const std::shared_ptr<const Snapshot> snapshot = snapshotOf(makeRoom());
  Technique technique;
  technique.resolution = kResolution;
  const std::array<Image, 6> captured = captureProbe(device, *snapshot, technique);
  const std::array<Image, 6> traced = traceFaces(snapshot);

  // Colours reach 1, so half floats round by kHalfRounding at most; interpolation of the colours in float adds a few
  // 1e-7.
  const double rasterTolerance = kHalfRounding + 1e-6;
  // On an edge both neighbours are half a texel inside: the component across the edge is 1 on one side and 1 - 1/R on
  // the other, so their mean is short by 1 / (2R), times 0.5 for the colour. The third component's bilinear
  // interpolation is exact.
  const double edgeTolerance = 0.25 / kResolution;
  return {
      {"cube faces", "raster", "largest texel error", largestTexelError(captured), 0.0, rasterTolerance},
      {"cube faces", "reference", "largest texel error", largestTexelError(traced), 0.0, 4e-6},
      {"cube edges", "raster", "largest error on the 12 edges", largestEdgeError(captured), 0.0,
       edgeTolerance + rasterTolerance},
      {"cube edges", "reference", "largest error on the 12 edges", largestEdgeError(traced), 0.0, edgeTolerance + 4e-6},
  };
}

}  // namespace pb
