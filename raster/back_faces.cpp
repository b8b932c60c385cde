#include "raster/back_faces.h"

#include <array>

#include "raster/gpu_structs.h"

namespace pb {

BackFaces::Drawing::Drawing(const gl::Functions& gl, GLuint framebuffer, GLuint surface) : gl_(gl), surface_(surface) {
  constexpr std::array<float, 4> kNothing{};
  constexpr float kNearest = 1.0f;
  gl.GetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebufferBefore_);
  gl.GetIntegerv(GL_DEPTH_FUNC, &depthFuncBefore_);
  gl.GetBooleanv(GL_DEPTH_WRITEMASK, &writesDepthBefore_);
  gl.GetBooleanv(GL_COLOR_WRITEMASK, writesColorBefore_.data());
  scissorsBefore_ = gl.IsEnabled(GL_SCISSOR_TEST);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.Disable(GL_SCISSOR_TEST);
  gl.DepthMask(GL_TRUE);
  gl.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, kNothing.data());
  gl.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &kNearest);
  gl.DepthFunc(GL_LESS);  // depth is reversed: what is farther wins
}

BackFaces::Drawing::~Drawing() {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebufferBefore_));
  gl_.DepthFunc(static_cast<GLenum>(depthFuncBefore_));
  gl_.DepthMask(writesDepthBefore_);
  const auto& [red, green, blue, alpha] = writesColorBefore_;
  gl_.ColorMask(red, green, blue, alpha);
  if (scissorsBefore_ == GL_TRUE) gl_.Enable(GL_SCISSOR_TEST);
  gl_.BindTextureUnit(gpu::kBackFaceUnit, surface_);
}

BackFaces::Drawing BackFaces::beginDraws(int widthPx, int heightPx) {
  const Target& target = targetOf(widthPx, heightPx);
  return Drawing(context_.functions(), target.framebuffer.id(), target.surface.id());
}

BackFaces::Target& BackFaces::targetOf(int widthPx, int heightPx) {
  const auto [found, isNew] = targets_.try_emplace({widthPx, heightPx});
  Target& target = found->second;
  if (!isNew) return target;
  checkBackFacesFit(limits_, widthPx, heightPx);
  const gl::Functions& gl = context_.functions();
  target.surface =
      gl::makeTexture(gl, {.target = GL_TEXTURE_2D, .format = GL_RGBA32F, .width = widthPx, .height = heightPx});
  gl.TextureParameteri(target.surface.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TextureParameteri(target.surface.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  target.depth = gl::makeTexture(
      gl, {.target = GL_TEXTURE_2D, .format = GL_DEPTH_COMPONENT32F, .width = widthPx, .height = heightPx});
  context_.check("allocating the image of back faces");
  target.framebuffer = gl::makeFramebuffer(gl, target.surface, target.depth);
  return target;
}

}  // namespace pb
