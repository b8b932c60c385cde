#include "raster/capture_history.h"

#include <utility>

#include "raster/gpu_structs.h"
#include "raster/probe_owners.h"

namespace pb {

CaptureHistory::CaptureHistory(gl::Context& context, Programs& programs, float share)
    : gl_(context.functions()),
      program_(programs.blendHistory()),
      share_(share),
      noVertices_(gl::makeVertexArray(gl_)) {}

void CaptureHistory::blend(const ProbeFace& face, const RenderTarget& target, const gl::Texture& captured,
                           bool isLast) {
  Earlier& earlier = earlierOf(face.probe, target, captured);
  bool& isKept = earlier.isKept[static_cast<std::size_t>(face.face)];
  if (isKept) mixIn(earlier, face.face, target);
  if (!isLast) return;
  gl_.CopyImageSubData(captured.id(), GL_TEXTURE_2D_ARRAY, 0, 0, 0, face.face, earlier.layers.id(), GL_TEXTURE_2D_ARRAY,
                       0, 0, 0, face.face, target.widthPx, target.heightPx, 1);
  isKept = true;
}

void CaptureHistory::reorder(const std::vector<int>& before) {
  std::vector<Earlier> earlier(before.size());
  for (std::size_t probe = 0; probe < before.size(); ++probe)
    if (const auto index = static_cast<std::size_t>(before[probe]);
        before[probe] != kNewProbe && index < earlier_.size())
      earlier[probe] = std::move(earlier_[index]);
  earlier_ = std::move(earlier);
}

// Starts anew when the map's size changes.
CaptureHistory::Earlier& CaptureHistory::earlierOf(int probe, const RenderTarget& target, const gl::Texture& captured) {
  const auto index = static_cast<std::size_t>(probe);
  while (earlier_.size() <= index) earlier_.emplace_back();
  Earlier& earlier = earlier_[index];
  if (earlier.sizePx == target.widthPx) return earlier;
  GLint format = 0;
  gl_.GetTextureLevelParameteriv(captured.id(), 0, GL_TEXTURE_INTERNAL_FORMAT, &format);
  earlier = {.layers = gl::makeTexture(gl_, {.target = GL_TEXTURE_2D_ARRAY,
                                             .format = static_cast<GLenum>(format),
                                             .width = target.widthPx,
                                             .height = target.heightPx,
                                             .layers = 6}),
             .sizePx = target.widthPx};
  return earlier;
}

void CaptureHistory::mixIn(const Earlier& earlier, int face, const RenderTarget& target) const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  gl_.Viewport(0, 0, target.widthPx, target.heightPx);
  gl_.Disable(GL_CULL_FACE);
  gl_.Disable(GL_DEPTH_TEST);  // and so nothing is written to the depth buffer, which lookups may read
  gl_.Enable(GL_BLEND);
  gl_.BlendColor(0.0f, 0.0f, 0.0f, share_);
  gl_.BlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
  gl_.BindTextureUnit(gpu::kFilterSourceUnit, earlier.layers.id());
  gl_.UseProgram(program_);
  gl_.ProgramUniform1i(program_, 0, face);
  gl_.BindVertexArray(noVertices_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

}  // namespace pb
