#include "raster/transparency.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "raster/gpu_structs.h"
#include "raster/scene_pass.h"
#include "scenes/error.h"

namespace pb {
namespace {

// Of LayerBlock in raster/shaders/layers.glsl.
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kLayerBytes = 32;
// 1 GiB: more is drawn in strips.
constexpr std::size_t kLargestBytes = std::size_t{1} << 30;

std::size_t largestCapacity(const gl::Context& context) {
  const auto blockBytes = static_cast<std::size_t>(context.integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE));
  return (std::min(blockBytes, kLargestBytes) - kHeaderBytes) / kLayerBytes;
}

}  // namespace

TransparentLayers::TransparentLayers(gl::Context& context, GLuint composeProgram)
    : gl_(context.functions()),
      program_(composeProgram),
      largestCapacity_(largestCapacity(context)),
      noVertices_(gl::makeVertexArray(gl_)) {}

void TransparentLayers::compose(const RenderTarget& target, const std::function<void()>& draw) {
  fitHeads(target.widthPx, target.heightPx);
  const auto samples = static_cast<std::size_t>(target.widthPx) * static_cast<std::size_t>(target.heightPx);
  if (capacity_ < std::min(samples, largestCapacity_)) reserve(samples);
  gl_.Enable(GL_SCISSOR_TEST);
  composeRows(target, {0, target.heightPx}, draw);
  gl_.Disable(GL_SCISSOR_TEST);
}

void TransparentLayers::composeRows(const RenderTarget& target, Rows rows, const std::function<void()>& draw) {
  gl_.Scissor(0, rows.first, target.widthPx, rows.count);
  std::size_t layers = collect(target, rows, draw);
  if (layers > capacity_ && capacity_ < largestCapacity_) {
    reserve(layers);
    layers = collect(target, rows, draw);
  }
  if (layers <= capacity_) return overlay();
  if (rows.count == 1)
    throwEnvironmentError("a row of the image has {} samples of blended surfaces, the device has memory for {}", layers,
                          capacity_);
  const int half = rows.count / 2;
  composeRows(target, {rows.first, half}, draw);
  composeRows(target, {rows.first + half, rows.count - half}, draw);
}

// Returns how many layers there are, whether or not there was room for them.
std::size_t TransparentLayers::collect(const RenderTarget& target, Rows rows, const std::function<void()>& draw) {
  constexpr std::uint32_t kNone = 0;
  gl_.ClearTexSubImage(heads_.id(), 0, 0, rows.first, 0, target.widthPx, rows.count, 1, GL_RED_INTEGER, GL_UNSIGNED_INT,
                       &kNone);
  layers_.write(0, gl::bytesOf(LayerCounts{}));
  gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, gpu::kLayerBlock, layers_.id());
  gl_.BindImageTexture(gpu::kLayerHeadImage, heads_.id(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
  gl_.DepthFunc(GL_GREATER);
  gl_.DepthMask(GL_FALSE);
  gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw();
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.DepthMask(GL_TRUE);
  return readCounts().layers;
}

void TransparentLayers::overlay() {
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.UseProgram(program_);
  gl_.BindVertexArray(noVertices_.id());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  if (readCounts().notComposed > 0)
    throwEnvironmentError("the driver can't sort as many blended surfaces as lie behind each other in this picture");
}

TransparentLayers::LayerCounts TransparentLayers::readCounts() const {
  gl_.MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
  LayerCounts counts;
  gl_.GetNamedBufferSubData(layers_.id(), 0, sizeof counts, &counts);
  return counts;
}

void TransparentLayers::fitHeads(int widthPx, int heightPx) {
  if (widthPx <= headsWidthPx_ && heightPx <= headsHeightPx_) return;
  headsWidthPx_ = std::max(headsWidthPx_, widthPx);
  headsHeightPx_ = std::max(headsHeightPx_, heightPx);
  heads_ = gl::makeTexture(
      gl_, {.target = GL_TEXTURE_2D, .format = GL_R32UI, .width = headsWidthPx_, .height = headsHeightPx_});
  // Textures of integers that are filtered are incomplete.
  gl_.TextureParameteri(heads_.id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl_.TextureParameteri(heads_.id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// A quarter more than asked for, so that a moving camera seldom makes it grow again.
void TransparentLayers::reserve(std::size_t layers) {
  capacity_ = std::min(layers + layers / 4, largestCapacity_);
  layers_ = gl::Buffer();  // first, so that both needn't fit
  layers_ = gl::Buffer(gl_, kHeaderBytes + capacity_ * kLayerBytes);
}

}  // namespace pb
