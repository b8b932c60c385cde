// OpenGL 4.5 core contexts without a window, through OSMesa or EGL. Both may live in one process.
#pragma once

#include <memory>

namespace pb::gl {

// A context of either library, as the library makes it.
class NativeContext {
 public:
  using Function = void (*)();

  NativeContext() = default;
  virtual ~NativeContext() = default;
  NativeContext(const NativeContext&) = delete;
  NativeContext& operator=(const NativeContext&) = delete;

  // To the calling thread. Throws an environment Error when the library refuses.
  virtual void bind() = 0;
  virtual void unbind() = 0;
  // Of this context's library: functions of the one must not be called in a context of the other.
  virtual Function function(const char* name) const = 0;
};

// Each throws an environment Error when OpenGL 4.5 core is not to be had there, or when this build lacks the library.
std::unique_ptr<NativeContext> createOsmesaContext();
// A hardware device if EGL lists one, else the surfaceless platform.
std::unique_ptr<NativeContext> createEglContext();

}  // namespace pb::gl
