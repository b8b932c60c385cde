#include "raster/gl/context.h"

#include <fmt/format.h>

#include <utility>

#include "scenes/error.h"

namespace pb::gl {
namespace {

// Both libraries keep a current context of their own but share one dispatch table, so only one of them may believe
// that it is bound.
thread_local NativeContext* boundContext = nullptr;

void bind(NativeContext& context) {
  if (boundContext == &context) return;
  if (boundContext != nullptr) boundContext->unbind();
  boundContext = nullptr;
  context.bind();
  boundContext = &context;
}

void unbind(NativeContext& context) {
  if (boundContext != &context) return;
  context.unbind();
  boundContext = nullptr;
}

GLADapiproc load(void* native, const char* name) { return static_cast<const NativeContext*>(native)->function(name); }

std::string errorName(GLenum error) {
  switch (error) {
    case GL_NO_ERROR:
      return "(undefined behaviour)";
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return fmt::format("{:#x}", error);
  }
}

}  // namespace

Context::Context(std::unique_ptr<NativeContext> native) : native_(std::move(native)) {
  makeCurrent();
  const int version = gladLoadGLContextUserPtr(&functions_, load, native_.get());
  if (version < GLAD_MAKE_VERSION(4, 5)) {
    unbind(*native_);
    throwEnvironmentError("OpenGL 4.5 is needed, the driver offers {}.{}", GLAD_VERSION_MAJOR(version),
                          GLAD_VERSION_MINOR(version));
  }
#ifndef NDEBUG
  functions_.Enable(GL_DEBUG_OUTPUT);
  functions_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  functions_.DebugMessageCallback(onDebugMessage, this);
#endif
}

Context::~Context() { unbind(*native_); }

void Context::makeCurrent() { bind(*native_); }

std::string Context::text(GLenum name) const {
  const GLubyte* value = functions_.GetString(name);
  return value == nullptr ? "" : reinterpret_cast<const char*>(value);
}

int Context::integer(GLenum name) const {
  GLint value = 0;
  functions_.GetIntegerv(name, &value);
  return value;
}

void Context::check(const char* task) {
  const GLenum error = functions_.GetError();
  if (error == GL_NO_ERROR && debugMessage_.empty()) return;
  // A context may hold several errors; the first is the cause. A lost context reports its loss for ever.
  for (GLenum next = error; next != GL_NO_ERROR && next != GL_CONTEXT_LOST;) next = functions_.GetError();
  const std::string detail = std::exchange(debugMessage_, {});
  throwEnvironmentError("OpenGL error {} while {}{}{}", errorName(error), task, detail.empty() ? "" : ": ", detail);
}

// No exception may pass through the driver: the message waits for check().
void Context::onDebugMessage(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum /*severity*/, GLsizei /*length*/,
                             const GLchar* message, const void* context) noexcept {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  auto* self = static_cast<Context*>(const_cast<void*>(context));
  if (self->debugMessage_.empty()) self->debugMessage_ = message;
}

}  // namespace pb::gl
