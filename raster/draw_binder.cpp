#include "raster/draw_binder.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace pb {
namespace {

// Counter-clockwise triangles stay so on their way to the window if s, t and forward are as left-handed as x, y and
// depth of GL's window; views and transforms may each turn them round.
GLenum frontFace(const shading::View& view, bool mirrored) {
  const float handedness = glm::dot(glm::cross(glm::vec3(view.right), glm::vec3(view.down)), glm::vec3(view.forward));
  return (handedness > 0.0f) != mirrored ? GL_CW : GL_CCW;
}

// Whether no point of the near plane is inside of the box.
bool isViewedFromOutside(const Bounds& box, const shading::View& view) {
  const float reach = view.origin.w * (glm::length(glm::vec3(view.forward)) + glm::length(glm::vec3(view.right)) +
                                       glm::length(glm::vec3(view.down)));
  const glm::vec3 origin(view.origin);
  return glm::distance(glm::clamp(origin, box.lower, box.upper), origin) > reach;
}

}  // namespace

Sides sidesOf(const SurfaceDraw& draw, const Snapshot& snapshot, const shading::View& view) {
  const bool showsFrontOnly =
      draw.cullsBackFaces ||
      (draw.isClosedGlass && isViewedFromOutside(snapshot.instances[draw.instance].worldBounds, view));
  return showsFrontOnly ? Sides::front : Sides::both;
}

void DrawBinder::draw(const SurfaceDraw& draw, GLuint program, Sides sides, const IndexRange& range) {
  if (program != program_) gl_.UseProgram(program_ = program);
  if (draw.mesh != mesh_ || range.buffer != indices_) bindMesh(draw.mesh, range.buffer);
  if (draw.material != material_) bindMaterial(draw.material);
  setSides(sides, frontFace(view_, frame_.snapshot.instances[draw.instance].mirrored));
  frame_.instances.bind(gpu::kInstanceBlock, draw.instance);
  gl_.DrawElements(GL_TRIANGLES, range.count, GL_UNSIGNED_INT, reinterpret_cast<const void*>(range.firstByte));
}

void DrawBinder::bindMesh(const GpuMesh* mesh, GLuint indices) {
  mesh_ = mesh;
  indices_ = indices;
  if (indices != 0) {
    gl_.VertexArrayElementBuffer(mesh->listedVertices.id(), indices);
    gl_.BindVertexArray(mesh->listedVertices.id());
  } else {
    const bool isReduced = reduction_.share < 1.0f;
    gl_.BindVertexArray(isReduced ? mesh->simplified.at(reduction_.share).vertexArray.id() : mesh->vertexArray.id());
  }
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kSmoothingGroupBlock, mesh->smoothingGroups.id());
}

void DrawBinder::bindMaterial(int material) {
  material_ = material;
  if (reduction_.isPlain) return frame_.resources.bindPlainMaterial(material);
  frame_.resources.bindMaterial(material);
}

void DrawBinder::setSides(Sides sides, GLenum front) {
  if (front != front_) gl_.FrontFace(front_ = front);
  if (sides == sides_) return;
  sides_ = sides;
  if (sides == Sides::both) return gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_CULL_FACE);
  gl_.CullFace(sides == Sides::front ? GL_BACK : GL_FRONT);
}

}  // namespace pb
