#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "raster/gl/native_context.h"
#include "scenes/error.h"

namespace pb::gl {
namespace {

bool hasExtension(const char* extensions, std::string_view name) {
  if (extensions == nullptr) return false;
  return fmt::format(" {} ", extensions).find(fmt::format(" {} ", name)) != std::string::npos;
}

const char* clientExtensions() { return eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS); }

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::vector<EGLDeviceEXT> hardwareDevices() {
  if (!hasExtension(clientExtensions(), "EGL_EXT_device_enumeration") ||
      !hasExtension(clientExtensions(), "EGL_EXT_platform_device"))
    return {};
  const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto queryDeviceString = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  if (queryDevices == nullptr || queryDeviceString == nullptr) return {};
  EGLint count = 0;
  if (queryDevices(0, nullptr, &count) != EGL_TRUE) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (queryDevices(count, devices.data(), &count) != EGL_TRUE) return {};
  devices.resize(static_cast<std::size_t>(count));
  std::erase_if(devices, [&](EGLDeviceEXT device) {
    return hasExtension(queryDeviceString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  return devices;
}

// In the order in which they are tried.
std::vector<EGLDisplay> candidateDisplays() {
  std::vector<EGLDisplay> displays;
  for (EGLDeviceEXT device : hardwareDevices())
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  if (hasExtension(clientExtensions(), "EGL_MESA_platform_surfaceless"))
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  std::erase(displays, EGL_NO_DISPLAY);
  return displays;
}

// Pbuffer configurations, because the default of eglChooseConfig is windows, which these platforms don't have.
EGLConfig chooseConfig(EGLDisplay display) {
  const EGLint attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, attributes, &config, 1, &count) != EGL_TRUE || count == 0) return nullptr;
  return config;
}

EGLContext createContext(EGLDisplay display, EGLConfig config) {
#ifdef NDEBUG
  const EGLint debug = EGL_FALSE;
#else
  const EGLint debug = EGL_TRUE;
#endif
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG,
                               debug,
                               EGL_NONE};
  if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return EGL_NO_CONTEXT;
  return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
}

class EglContext : public NativeContext {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  // The display stays initialised: it is the process's, and other contexts may live on it.
  ~EglContext() override { eglDestroyContext(display_, context_); }

  void bind() override {
    // The API is a state of the calling thread.
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE ||
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE)
      throwEnvironmentError("eglMakeCurrent failed with EGL error {:#x}", eglGetError());
  }
  void unbind() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  Function function(const char* name) const override { return eglGetProcAddress(name); }

 private:
  EGLDisplay display_;
  EGLContext context_;
};

}  // namespace

std::unique_ptr<NativeContext> createEglContext() {
  EGLint lastError = EGL_NOT_INITIALIZED;
  for (EGLDisplay display : candidateDisplays()) {
    if (eglInitialize(display, nullptr, nullptr) == EGL_TRUE) {
      const EGLConfig config = chooseConfig(display);
      const EGLContext context = config == nullptr ? EGL_NO_CONTEXT : createContext(display, config);
      if (context != EGL_NO_CONTEXT) return std::make_unique<EglContext>(display, context);
    }
    lastError = eglGetError();
  }
  throwEnvironmentError("EGL offers no OpenGL 4.5 core context on any device or without a display (EGL error {:#x})",
                        lastError);
}

}  // namespace pb::gl
