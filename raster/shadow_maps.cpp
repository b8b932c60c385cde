#include "raster/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "raster/scene_pass.h"
#include "scenes/error.h"

namespace pb {
namespace {

constexpr std::int64_t kDepthBytes = 4;  // D32F
// Cones that are wider than 60 degrees to a side waste most of one face's texels at its edges.
constexpr float kNarrowCone = 0.5f;  // cosine
// Reversed float depth loses nothing by a near plane that is near.
constexpr float kNearOfExtent = 1e-4f;
// Keeps what lies on the sides of the scene's bounds inside.
constexpr float kMargin = 1e-3f;

// Cosine of the cone's outer angle: where the light's angular falloff ends.
float coneCosine(const shading::Light& light) { return -light.cone.y / light.cone.x; }

// A face's extent with a texel to spare on each side.
float withBorder(float extent, int resolution) {
  return extent * static_cast<float>(resolution) / static_cast<float>(resolution - 2);
}

// Any two unit vectors that make a right angle with `forward` and each other.
void setSides(shading::View& view, const glm::vec3& forward, float right, float down) {
  const glm::vec3 helper = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  const glm::vec3 x = glm::normalize(glm::cross(forward, helper));
  view.forward = glm::vec4(forward, 0.0f);
  view.right = glm::vec4(right * x, 0.0f);
  view.down = glm::vec4(down * glm::cross(forward, x), 0.0f);
}

// Parallel: the origin lies in the middle of the side of the box where light enters, the box is as large as it has to
// be.
gpu::ShadowFace directionalFace(const glm::vec3& forward, const Bounds& casters, int resolution) {
  gpu::ShadowFace face{};
  setSides(face.view, forward, 1.0f, 1.0f);
  const glm::vec3 right(face.view.right), down(face.view.down);
  const glm::vec3 half = 0.5f * casters.extent();
  const auto reach = [&](const glm::vec3& axis) {
    return (1.0f + kMargin) * std::max(glm::dot(glm::abs(axis), half), kNearOfExtent);
  };
  const float depth = reach(forward);
  face.view.origin = glm::vec4(casters.centre() - depth * forward, 0.0f);
  face.view.right = glm::vec4(withBorder(reach(right), resolution) * right, 0.0f);
  face.view.down = glm::vec4(withBorder(reach(down), resolution) * down, 0.0f);
  face.values = {1.0f, 2.0f * depth, 0.0f, 0.0f};
  return face;
}

}  // namespace

std::vector<gpu::ShadowFace> shadowFacesOf(const shading::Light& light, const Bounds& casters, int resolution) {
  const glm::vec3 forward(light.directionRange), position(light.positionKind);
  if (light.positionKind.w == shading::kLightDirectional) return {directionalFace(forward, casters, resolution)};
  const float zNear = kNearOfExtent * std::max(glm::length(casters.extent()), kMargin);
  const bool isNarrow = light.positionKind.w == shading::kLightSpot && coneCosine(light) >= kNarrowCone;
  std::vector<gpu::ShadowFace> faces(isNarrow ? 1 : 6);
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    shading::View& view = faces[static_cast<std::size_t>(f)].view;
    if (isNarrow) {
      const float cosine = std::min(coneCosine(light), 1.0f - kMargin * kMargin);
      const float tangent = withBorder(std::sqrt(1.0f - cosine * cosine) / cosine, resolution);
      setSides(view, forward, tangent, tangent);
      view.origin = glm::vec4(position, zNear);
    } else {
      view = cubeFaceView(position, f, zNear);
      view.right *= withBorder(1.0f, resolution);
      view.down *= withBorder(1.0f, resolution);
    }
  }
  return faces;
}

bool castsShadows(const Snapshot& snapshot) { return snapshot.scene->castsShadows && !snapshot.lights.empty(); }

ShadowMaps::ShadowMaps(gl::Context& context, const DeviceLimits& limits, int resolution)
    : context_(context), gl_(context.functions()), limits_(limits), resolution_(resolution) {}

void ShadowMaps::beginFrame(const Snapshot& snapshot) {
  Bounds casters;
  for (const SnapshotInstance& instance : snapshot.instances) casters.include(instance.worldBounds);
  faces_.clear();
  lights_ = snapshot.lights;
  for (shading::Light& light : lights_) {
    const std::vector<gpu::ShadowFace> faces = shadowFacesOf(light, casters, resolution_);
    light.cone.z = static_cast<float>(faces_.size());
    light.cone.w = static_cast<float>(faces.size());
    faces_.insert(faces_.end(), faces.begin(), faces.end());
  }
  allocate(static_cast<int>(faces_.size()));
  for (std::size_t f = 0; f < faces_.size(); ++f) faceSlots_.set(f, faces_[f]);
  faceSlots_.upload();
  faceBuffer_.write(0, gl::bytesOf(faces_));
}

RenderTarget ShadowMaps::target(std::size_t face) {
  constexpr float kFarthest = 0.0f;
  gl::setDepthLayer(framebuffer_, depths_, static_cast<int>(face));
  gl_.ClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kFarthest);
  faceSlots_.bind(gpu::kShadowPassBlock, face);
  return {framebuffer_.id(), resolution_, resolution_};
}

void ShadowMaps::bind() const {
  gl_.BindTextureUnit(gpu::kShadowUnit, depths_.id());
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kShadowBlock, faceBuffer_.id());
}

void ShadowMaps::allocate(int layers) {
  if (layers == layers_) return;
  const std::int64_t bytes = kDepthBytes * resolution_ * resolution_ * layers;
  if (resolution_ > limits_.textureSizePx || layers > limits_.arrayLayers || bytes > limits_.bytes)
    throwInputError("the shadow maps want {} faces of {}x{} texels, the device allows {} of {}x{} and {} MiB", layers,
                    resolution_, resolution_, limits_.arrayLayers, limits_.textureSizePx, limits_.textureSizePx,
                    limits_.bytes / (1024 * 1024));
  layers_ = layers;
  faceSlots_ = UniformSlots<gpu::ShadowFace>(context_, static_cast<std::size_t>(layers));
  faceBuffer_ = gl::Buffer(gl_, static_cast<std::size_t>(layers) * sizeof(gpu::ShadowFace));
  depths_ = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                  .format = GL_DEPTH_COMPONENT32F,
                                  .width = resolution_,
                                  .height = resolution_,
                                  .layers = layers});
  context_.check("allocating shadow maps");
  framebuffer_ = gl::makeDepthFramebuffer(gl_, depths_);
}

}  // namespace pb
