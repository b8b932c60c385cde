#include "raster/back_faces.h"

#include <array>

#include "raster/gpu_structs.h"

namespace pb {

void BackFaces::beginDraws(int widthPx, int heightPx) {
  constexpr std::array<float, 4> kNothing{};
  constexpr float kNearest = 1.0f;
  const gl::Functions& gl = context_.functions();
  current_ = &targetOf(widthPx, heightPx);
  const GLuint framebuffer = current_->framebuffer.id();
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.ClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, kNothing.data());
  gl.ClearNamedFramebufferfv(framebuffer, GL_DEPTH, 0, &kNearest);
  gl.DepthFunc(GL_LESS);  // depth is reversed: what is farther wins
}

void BackFaces::bind() const { context_.functions().BindTextureUnit(gpu::kBackFaceUnit, current_->surface.id()); }

BackFaces::Target& BackFaces::targetOf(int widthPx, int heightPx) {
  const auto [found, isNew] = targets_.try_emplace({widthPx, heightPx});
  Target& target = found->second;
  if (!isNew) return target;
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
