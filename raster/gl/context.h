// A current OpenGL context with its functions. Everything that calls GL goes through Functions: entry points belong to
// the context they were loaded for.
#pragma once

#include <glad/gl.h>

#include <memory>
#include <string>

#include "raster/gl/native_context.h"

namespace pb::gl {

using Functions = GladGLContext;

// A context may be used by one thread at a time. Destroy what was made in it first.
class Context {
 public:
  // Leaves the context current. Throws an environment Error if it is older than OpenGL 4.5.
  explicit Context(std::unique_ptr<NativeContext> native);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  // Free if it is current already.
  void makeCurrent();

  const Functions& functions() const { return functions_; }
  std::string text(GLenum name) const;  // of glGetString
  int integer(GLenum name) const;       // of glGetIntegerv

  // Throws an environment Error for the first GL error since the last check; `task` completes "OpenGL error ... while".
  void check(const char* task);

 private:
  static void GLAD_API_PTR onDebugMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                          const GLchar* message, const void* context) noexcept;

  std::unique_ptr<NativeContext> native_;
  Functions functions_{};
  std::string debugMessage_;  // the first since the last check; debug builds only
};

}  // namespace pb::gl
