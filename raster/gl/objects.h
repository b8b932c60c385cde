// Owners of GL objects, made and filled with direct state access. Their context must be current whenever one is made,
// used or destroyed. A driver out of memory shows at the next Context::check().
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "raster/gl/context.h"

namespace pb::gl {

// One object name; Delete is the member of Functions that frees names of its kind.
template <auto Delete>
class Name {
 public:
  Name() = default;
  Name(const Functions& gl, GLuint id) : gl_(&gl), id_(id) {}
  ~Name() {
    if (id_ != 0) (gl_->*Delete)(1, &id_);
  }
  Name(Name&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(gl_, other.gl_);
    std::swap(id_, other.id_);
    return *this;
  }

  const Functions& gl() const { return *gl_; }
  GLuint id() const { return id_; }

 private:
  const Functions* gl_ = nullptr;
  GLuint id_ = 0;
};

class Buffer : public Name<&Functions::DeleteBuffers> {
 public:
  Buffer() = default;
  // Never changes afterwards. GL has no empty buffers: no bytes make a buffer of a few unused ones.
  Buffer(const Functions& gl, std::span<const std::byte> bytes);
  // Contents come by write().
  Buffer(const Functions& gl, std::size_t capacityBytes);

  void write(std::size_t offset, std::span<const std::byte> bytes);
};

// Storage is immutable: sizes and format are those it was made with.
class Texture : public Name<&Functions::DeleteTextures> {
 public:
  using Name::Name;
};

struct TextureShape {
  GLenum target;  // GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY or GL_TEXTURE_CUBE_MAP_ARRAY
  GLenum format;
  int width;
  int height;
  int layers = 1;  // 6 for each cube
  int levels = 1;
};
Texture makeTexture(const Functions& gl, const TextureShape& shape);

// What another texture's storage is seen as, from its first level and layer on.
struct ViewShape {
  GLenum target;
  GLenum format;
  int levels = 1;
  int layers = 6;
};
Texture makeView(const Texture& texture, const ViewShape& shape);
// The six layers of a GL_TEXTURE_2D_ARRAY as a cube map.
Texture makeCubeView(const Texture& layers, GLenum format);

class Sampler : public Name<&Functions::DeleteSamplers> {
 public:
  using Name::Name;
};
Sampler makeSampler(const Functions& gl, GLenum magFilter, GLenum minFilter, GLenum wrapS, GLenum wrapT);

class VertexArray : public Name<&Functions::DeleteVertexArrays> {
 public:
  using Name::Name;
};
VertexArray makeVertexArray(const Functions& gl);

class Framebuffer : public Name<&Functions::DeleteFramebuffers> {
 public:
  using Name::Name;
};
// Colour attachment 0 and depth. Throws an environment Error if the driver can't render to them.
Framebuffer makeFramebuffer(const Functions& gl, const Texture& color, const Texture& depth);
// The same with one layer of an array texture as colour, chosen anew with setColorLayer().
Framebuffer makeLayerFramebuffer(const Functions& gl, const Texture& colorLayers, const Texture& depth);
void setColorLayer(const Framebuffer& framebuffer, const Texture& colorLayers, int layer);
// Depth alone, of one layer of an array texture, chosen anew with setDepthLayer().
Framebuffer makeDepthFramebuffer(const Functions& gl, const Texture& depthLayers);
void setDepthLayer(const Framebuffer& framebuffer, const Texture& depthLayers, int layer);

class Query : public Name<&Functions::DeleteQueries> {
 public:
  using Name::Name;
};
Query makeQuery(const Functions& gl, GLenum target);
// Waits for the result.
std::uint64_t queryResult(const Query& query);

struct ShaderSource {
  GLenum stage;
  std::string name;  // for messages
  std::string text;
};

class Program {
 public:
  // Throws an environment Error with the driver's log if a stage doesn't compile or the stages don't link.
  Program(const Functions& gl, const std::vector<ShaderSource>& sources);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  GLuint id() const { return id_; }

 private:
  const Functions& gl_;
  GLuint id_;
};

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}
template <class T>
std::span<const std::byte> bytesOf(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

}  // namespace pb::gl
