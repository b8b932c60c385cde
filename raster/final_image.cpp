#include "raster/final_image.h"

#include <glm/vec4.hpp>

namespace pb {
namespace {

gl::Texture makeImage(const gl::Functions& gl, GLenum format, int width, int height) {
  return gl::makeTexture(gl, {.target = GL_TEXTURE_2D, .format = format, .width = width, .height = height});
}

// All texels, four components each, as one array of rows.
template <class Texel>
Grid<Texel> readTexels(const gl::Texture& texture, GLenum format, GLenum type, int width, int height) {
  Grid<Texel> texels(width, height);
  texture.gl().GetTextureSubImage(texture.id(), 0, 0, 0, 0, width, height, 1, format, type,
                                  static_cast<GLsizei>(texels.size() * sizeof(Texel)), texels.data());
  return texels;
}

}  // namespace

FinalImage::FinalImage(gl::Context& context, int widthPx, int heightPx, int samplesPerAxis)
    : gl_(context.functions()),
      widthPx_(widthPx),
      heightPx_(heightPx),
      samplesPerAxis_(samplesPerAxis),
      color_(makeImage(gl_, GL_RGBA32F, widthSamples(), heightSamples())),
      depth_(makeImage(gl_, GL_DEPTH_COMPONENT32F, widthSamples(), heightSamples())) {
  context.check("allocating the image");
  framebuffer_ = gl::makeFramebuffer(gl_, color_, depth_);
}

Image FinalImage::read() const {
  const auto samples = readTexels<glm::vec4>(color_, GL_RGBA, GL_FLOAT, widthSamples(), heightSamples());
  const float weight = 1.0f / static_cast<float>(samplesPerAxis_ * samplesPerAxis_);
  Image image(widthPx_, heightPx_);
  for (int y = 0; y < heightPx_; ++y)
    for (int x = 0; x < widthPx_; ++x) {
      glm::vec3 sum(0.0f);
      for (int j = 0; j < samplesPerAxis_; ++j)
        for (int i = 0; i < samplesPerAxis_; ++i)
          sum += glm::vec3(samples(x * samplesPerAxis_ + i, y * samplesPerAxis_ + j));
      image(x, y) = weight * sum;
    }
  return image;
}

IdImage::IdImage(gl::Context& context, int widthSamples, int heightSamples)
    : gl_(context.functions()),
      widthSamples_(widthSamples),
      heightSamples_(heightSamples),
      ids_(makeImage(gl_, GL_RGBA32UI, widthSamples, heightSamples)),
      depth_(makeImage(gl_, GL_DEPTH_COMPONENT32F, widthSamples, heightSamples)) {
  context.check("allocating the image of ids");
  framebuffer_ = gl::makeFramebuffer(gl_, ids_, depth_);
}

Grid<SampleId> IdImage::read() const {
  const auto texels = readTexels<glm::uvec4>(ids_, GL_RGBA_INTEGER, GL_UNSIGNED_INT, widthSamples_, heightSamples_);
  Grid<SampleId> ids(widthSamples_, heightSamples_);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = {texels[i].x, texels[i].y, texels[i].z};
  return ids;
}

}  // namespace pb
