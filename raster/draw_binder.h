// Sets the state of the draws of one pass, leaving what is set already.
#pragma once

#include "raster/scene_draws.h"
#include "raster/uniform_slots.h"
#include "scenes/snapshot.h"

namespace pb {

enum class Sides { both, front, back };

// A part of a draw's triangles, which keep their order.
struct IndexRange {
  GLsizei count;
  std::size_t firstByte = 0;
  GLuint buffer = 0;  // 0: the mesh's own
};

// Closed glass is drawn without its back faces as long as they can't be seen.
Sides sidesOf(const SurfaceDraw& draw, const Snapshot& snapshot, const shading::View& view);

class DrawBinder {
 public:
  struct Frame {
    const gl::Functions& gl;
    const SceneResources& resources;
    const Snapshot& snapshot;
    const UniformSlots<gpu::InstanceConstants>& instances;
  };
  // How captures may reduce what they draw.
  struct Reduction {
    float share;   // of the triangles
    bool isPlain;  // materials without textures
  };
  DrawBinder(const Frame& frame, const shading::View& view, const Reduction& reduction)
      : frame_(frame), gl_(frame.gl), view_(view), reduction_(reduction) {}

  void draw(const SurfaceDraw& draw, GLuint program) {
    this->draw(draw, program, sidesOf(draw, frame_.snapshot, view_));
  }
  void draw(const SurfaceDraw& draw, GLuint program, Sides sides) {
    this->draw(draw, program, sides, {.count = draw.indexCount(reduction_.share)});
  }
  void draw(const SurfaceDraw& draw, GLuint program, Sides sides, const IndexRange& range);

 private:
  void bindMesh(const GpuMesh* mesh, GLuint indices);
  void bindMaterial(int material);
  void setSides(Sides sides, GLenum front);

  const Frame frame_;
  const gl::Functions& gl_;
  const shading::View& view_;
  const Reduction reduction_;
  GLuint program_ = 0;
  const GpuMesh* mesh_ = nullptr;
  GLuint indices_ = 0;  // IndexRange::buffer
  int material_ = -1;
  GLenum front_ = GL_NONE;
  Sides sides_ = Sides::both;  // as the pass leaves it
};

}  // namespace pb
