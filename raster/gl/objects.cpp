#include "raster/gl/objects.h"

#include <algorithm>
#include <array>
#include <sstream>

#include "scenes/error.h"

namespace pb::gl {
namespace {

constexpr std::size_t kSmallestBuffer = 16;  // bytes; any size above zero would do

GLuint createBuffer(const Functions& gl) {
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  return id;
}

GLuint createFramebuffer(const Functions& gl) {
  GLuint id = 0;
  gl.CreateFramebuffers(1, &id);
  return id;
}

// Drivers' logs have many lines; messages are one.
std::string onOneLine(const std::string& log) {
  std::istringstream lines(log);
  std::string result;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) result += (result.empty() ? "" : "; ") + line;
  return result;
}

// Of a shader or a program, by the functions that read its parameters and its log.
template <class GetParameter, class GetLog>
std::string infoLog(GLuint id, GetParameter getParameter, GetLog getLog) {
  GLint length = 0;
  getParameter(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  getLog(id, length, nullptr, log.data());
  log.resize(log.find('\0'));
  return onOneLine(log);
}

// A shader object for as long as its program is being linked.
class Shader {
 public:
  Shader(const Functions& gl, const ShaderSource& source) : gl_(gl), id_(gl.CreateShader(source.stage)) {
    const char* text = source.text.c_str();
    gl.ShaderSource(id_, 1, &text, nullptr);
    gl.CompileShader(id_);
    GLint compiled = GL_FALSE;
    gl.GetShaderiv(id_, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return;
    const std::string log = infoLog(id_, gl.GetShaderiv, gl.GetShaderInfoLog);
    gl.DeleteShader(id_);
    throwEnvironmentError("the driver can't compile shader {}: {}", source.name, log);
  }
  ~Shader() {
    if (id_ != 0) gl_.DeleteShader(id_);
  }
  Shader(Shader&& other) noexcept : gl_(other.gl_), id_(std::exchange(other.id_, 0)) {}

  GLuint id() const { return id_; }

 private:
  const Functions& gl_;
  GLuint id_;
};

GLuint link(const Functions& gl, const std::vector<ShaderSource>& sources) {
  std::vector<Shader> shaders;
  for (const ShaderSource& source : sources) shaders.emplace_back(gl, source);
  const GLuint program = gl.CreateProgram();
  for (const Shader& shader : shaders) gl.AttachShader(program, shader.id());
  gl.LinkProgram(program);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  for (const Shader& shader : shaders) gl.DetachShader(program, shader.id());  // else it lives as long as the program
  if (linked == GL_TRUE) return program;
  const std::string log = infoLog(program, gl.GetProgramiv, gl.GetProgramInfoLog);
  gl.DeleteProgram(program);
  throwEnvironmentError("the driver can't link shader {}: {}", sources.back().name, log);
}

void requireComplete(const Functions& gl, GLuint framebuffer) {
  const GLenum status = gl.CheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throwEnvironmentError("the driver can't render to this combination of colour and depth (framebuffer status {:#x})",
                          status);
}

}  // namespace

Buffer::Buffer(const Functions& gl, std::span<const std::byte> bytes) : Name(gl, createBuffer(gl)) {
  static constexpr std::array<std::byte, kSmallestBuffer> kUnused{};
  const std::span<const std::byte> stored = bytes.empty() ? std::span<const std::byte>(kUnused) : bytes;
  gl.NamedBufferStorage(id(), static_cast<GLsizeiptr>(stored.size()), stored.data(), 0);
}

Buffer::Buffer(const Functions& gl, std::size_t capacityBytes) : Name(gl, createBuffer(gl)) {
  gl.NamedBufferStorage(id(), static_cast<GLsizeiptr>(std::max(capacityBytes, kSmallestBuffer)), nullptr,
                        GL_DYNAMIC_STORAGE_BIT);
}

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  gl().NamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

Texture makeTexture(const Functions& gl, const TextureShape& shape) {
  GLuint id = 0;
  gl.CreateTextures(shape.target, 1, &id);
  Texture texture(gl, id);
  if (shape.target == GL_TEXTURE_2D)
    gl.TextureStorage2D(id, shape.levels, shape.format, shape.width, shape.height);
  else
    gl.TextureStorage3D(id, shape.levels, shape.format, shape.width, shape.height, shape.layers);
  gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, shape.levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

Texture makeView(const Texture& texture, const ViewShape& shape) {
  const Functions& gl = texture.gl();
  GLuint id = 0;
  gl.GenTextures(1, &id);  // a view's name must not have a target yet
  Texture view(gl, id);
  gl.TextureView(id, shape.target, texture.id(), shape.format, 0, static_cast<GLuint>(shape.levels), 0,
                 static_cast<GLuint>(shape.layers));
  gl.TextureParameteri(id, GL_TEXTURE_MIN_FILTER, shape.levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
  gl.TextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return view;
}

Texture makeCubeView(const Texture& layers, GLenum format) { return makeView(layers, {GL_TEXTURE_CUBE_MAP, format}); }

Sampler makeSampler(const Functions& gl, GLenum magFilter, GLenum minFilter, GLenum wrapS, GLenum wrapT) {
  GLuint id = 0;
  gl.CreateSamplers(1, &id);
  Sampler sampler(gl, id);
  gl.SamplerParameteri(id, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magFilter));
  gl.SamplerParameteri(id, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minFilter));
  gl.SamplerParameteri(id, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrapS));
  gl.SamplerParameteri(id, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrapT));
  return sampler;
}

VertexArray makeVertexArray(const Functions& gl) {
  GLuint id = 0;
  gl.CreateVertexArrays(1, &id);
  return {gl, id};
}

Framebuffer makeFramebuffer(const Functions& gl, const Texture& color, const Texture& depth) {
  Framebuffer framebuffer(gl, createFramebuffer(gl));
  gl.NamedFramebufferTexture(framebuffer.id(), GL_COLOR_ATTACHMENT0, color.id(), 0);
  gl.NamedFramebufferTexture(framebuffer.id(), GL_DEPTH_ATTACHMENT, depth.id(), 0);
  requireComplete(gl, framebuffer.id());
  return framebuffer;
}

Framebuffer makeLayerFramebuffer(const Functions& gl, const Texture& colorLayers, const Texture& depth) {
  Framebuffer framebuffer(gl, createFramebuffer(gl));
  setColorLayer(framebuffer, colorLayers, 0);
  gl.NamedFramebufferTexture(framebuffer.id(), GL_DEPTH_ATTACHMENT, depth.id(), 0);
  requireComplete(gl, framebuffer.id());
  return framebuffer;
}

Framebuffer makeDepthFramebuffer(const Functions& gl, const Texture& depthLayers) {
  Framebuffer framebuffer(gl, createFramebuffer(gl));
  setDepthLayer(framebuffer, depthLayers, 0);
  gl.NamedFramebufferDrawBuffer(framebuffer.id(), GL_NONE);
  requireComplete(gl, framebuffer.id());
  return framebuffer;
}

void setDepthLayer(const Framebuffer& framebuffer, const Texture& depthLayers, int layer) {
  framebuffer.gl().NamedFramebufferTextureLayer(framebuffer.id(), GL_DEPTH_ATTACHMENT, depthLayers.id(), 0, layer);
}

void setColorLayer(const Framebuffer& framebuffer, const Texture& colorLayers, int layer) {
  framebuffer.gl().NamedFramebufferTextureLayer(framebuffer.id(), GL_COLOR_ATTACHMENT0, colorLayers.id(), 0, layer);
}

Query makeQuery(const Functions& gl, GLenum target) {
  GLuint id = 0;
  gl.CreateQueries(target, 1, &id);
  return {gl, id};
}

std::uint64_t queryResult(const Query& query) {
  GLuint64 result = 0;
  query.gl().GetQueryObjectui64v(query.id(), GL_QUERY_RESULT, &result);
  return result;
}

Program::Program(const Functions& gl, const std::vector<ShaderSource>& sources) : gl_(gl), id_(link(gl, sources)) {}

Program::~Program() { gl_.DeleteProgram(id_); }

}  // namespace pb::gl
