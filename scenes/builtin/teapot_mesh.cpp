#include "scenes/builtin/teapot_mesh.h"

#include <array>
#include <glm/vec2.hpp>

#include "scenes/builtin/shapes.h"

namespace pb {
namespace {

// The original's unit is half a metre here.
constexpr float kMetresPerUnit = 0.5f;

// Profiles (radius, height) of the surfaces of revolution, each a cubic Bezier curve, ordered so that the surface
// turned from it faces outwards.
using Profile = std::array<glm::vec2, 4>;
const std::array<Profile, 6> kProfiles = {{
    {{{1.4f, 2.4f}, {1.3375f, 2.53125f}, {1.4375f, 2.53125f}, {1.5f, 2.4f}}},  // rim
    {{{1.5f, 2.4f}, {1.75f, 1.875f}, {2.0f, 1.35f}, {2.0f, 0.9f}}},            // upper body
    {{{2.0f, 0.9f}, {2.0f, 0.45f}, {1.5f, 0.225f}, {1.5f, 0.15f}}},            // lower body
    {{{0.0f, 3.15f}, {0.8f, 3.15f}, {0.0f, 2.85f}, {0.2f, 2.7f}}},             // knob
    {{{0.2f, 2.7f}, {0.4f, 2.55f}, {1.3f, 2.55f}, {1.3f, 2.4f}}},              // lid
    {{{1.5f, 0.15f}, {1.5f, 0.075f}, {1.425f, 0.0f}, {0.0f, 0.0f}}},           // bottom
}};

// Handle and spout are symmetric: each patch spans the half with negative original y; rows run along the tube.
// Points are the original's (x, y, z) with z up.
const std::array<BezierPatch, 4> kHalfPatches = {{
    {{{-1.6f, 0, 2.025f},
      {-1.6f, -0.3f, 2.025f},
      {-1.5f, -0.3f, 2.25f},
      {-1.5f, 0, 2.25f},
      {-2.3f, 0, 2.025f},
      {-2.3f, -0.3f, 2.025f},
      {-2.5f, -0.3f, 2.25f},
      {-2.5f, 0, 2.25f},
      {-2.7f, 0, 2.025f},
      {-2.7f, -0.3f, 2.025f},
      {-3.0f, -0.3f, 2.25f},
      {-3.0f, 0, 2.25f},
      {-2.7f, 0, 1.8f},
      {-2.7f, -0.3f, 1.8f},
      {-3.0f, -0.3f, 1.8f},
      {-3.0f, 0, 1.8f}}},
    {{{-2.7f, 0, 1.8f},
      {-2.7f, -0.3f, 1.8f},
      {-3.0f, -0.3f, 1.8f},
      {-3.0f, 0, 1.8f},
      {-2.7f, 0, 1.575f},
      {-2.7f, -0.3f, 1.575f},
      {-3.0f, -0.3f, 1.35f},
      {-3.0f, 0, 1.35f},
      {-2.5f, 0, 1.125f},
      {-2.5f, -0.3f, 1.125f},
      {-2.65f, -0.3f, 0.9375f},
      {-2.65f, 0, 0.9375f},
      {-2.0f, 0, 0.9f},
      {-2.0f, -0.3f, 0.9f},
      {-1.9f, -0.3f, 0.6f},
      {-1.9f, 0, 0.6f}}},
    {{{1.7f, 0, 1.425f},
      {1.7f, -0.66f, 1.425f},
      {1.7f, -0.66f, 0.6f},
      {1.7f, 0, 0.6f},
      {2.6f, 0, 1.425f},
      {2.6f, -0.66f, 1.425f},
      {3.1f, -0.66f, 0.825f},
      {3.1f, 0, 0.825f},
      {2.3f, 0, 2.1f},
      {2.3f, -0.25f, 2.1f},
      {2.4f, -0.25f, 2.025f},
      {2.4f, 0, 2.025f},
      {2.7f, 0, 2.4f},
      {2.7f, -0.25f, 2.4f},
      {3.3f, -0.25f, 2.4f},
      {3.3f, 0, 2.4f}}},
    {{{2.7f, 0, 2.4f},
      {2.7f, -0.25f, 2.4f},
      {3.3f, -0.25f, 2.4f},
      {3.3f, 0, 2.4f},
      {2.8f, 0, 2.475f},
      {2.8f, -0.25f, 2.475f},
      {3.525f, -0.25f, 2.49375f},
      {3.525f, 0, 2.49375f},
      {2.9f, 0, 2.475f},
      {2.9f, -0.15f, 2.475f},
      {3.45f, -0.15f, 2.5125f},
      {3.45f, 0, 2.5125f},
      {2.8f, 0, 2.4f},
      {2.8f, -0.15f, 2.4f},
      {3.2f, -0.15f, 2.4f},
      {3.2f, 0, 2.4f}}},
}};

// The quarter turn from (dx, dz) to the perpendicular direction; the original approximates the circle with 0.56 where
// the best cubic has 0.5523, so the teapot's body is not exactly round.
BezierPatch quarterOf(const Profile& profile, glm::vec2 from, glm::vec2 to) {
  constexpr float kHandle = 0.56f;
  const std::array<glm::vec2, 4> arc = {from, from + kHandle * to, kHandle * from + to, to};
  BezierPatch patch;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      patch[4 * i + j] = kMetresPerUnit * glm::vec3(profile[i].x * arc[j].x, profile[i].y, profile[i].x * arc[j].y);
  return patch;
}

// z up to +Y up.
glm::vec3 upright(const glm::vec3& p) { return kMetresPerUnit * glm::vec3(p.x, p.z, -p.y); }

void appendHalves(Mesh& mesh, const BezierPatch& original, int segments) {
  BezierPatch near, far;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const glm::vec3 p = upright(original[4 * i + j]);
      near[4 * i + j] = p;
      far[4 * i + 3 - j] = glm::vec3(p.x, p.y, -p.z);  // columns reversed, so that the mirror image faces outwards too
    }
  appendPatch(mesh, near, segments);
  appendPatch(mesh, far, segments);
}

}  // namespace

Mesh makeTeapotMesh(int segments) {
  Mesh mesh;
  mesh.name = "teapot";
  const std::array<glm::vec2, 4> axes = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (const Profile& profile : kProfiles)
    for (std::size_t quarter = 0; quarter < 4; ++quarter)
      appendPatch(mesh, quarterOf(profile, axes[quarter], axes[(quarter + 1) % 4]), segments);
  for (const BezierPatch& patch : kHalfPatches) appendHalves(mesh, patch, segments);
  return mesh;
}

}  // namespace pb
