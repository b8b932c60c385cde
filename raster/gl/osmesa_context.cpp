#include "raster/gl/native_context.h"
#include "scenes/error.h"

#ifdef PROBEBENCH_OSMESA
#include <GL/osmesa.h>

#include <array>

#include "scenes/shared_library.h"
#endif

namespace pb::gl {

#ifdef PROBEBENCH_OSMESA
namespace {

// Loaded with the first context, as drivers are: with LLVM behind it, linking took 20 ms of the start of every command.
struct Osmesa {
  SharedLibrary library{PROBEBENCH_OSMESA_SONAME};  // of the library that CMake found
  decltype(&OSMesaCreateContextAttribs) createContext =
      library.symbol<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
  decltype(&OSMesaDestroyContext) destroyContext =
      library.symbol<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext");
  decltype(&OSMesaMakeCurrent) makeCurrent = library.symbol<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent");
  decltype(&OSMesaGetProcAddress) getProcAddress =
      library.symbol<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress");
};

const Osmesa& osmesa() {
  static const Osmesa loaded;
  return loaded;
}

class OsmesaContext : public NativeContext {
 public:
  OsmesaContext() {
    // No depth or stencil: pictures go to framebuffer objects.
    const int attributes[] = {OSMESA_FORMAT,
                              OSMESA_RGBA,
                              OSMESA_DEPTH_BITS,
                              0,
                              OSMESA_STENCIL_BITS,
                              0,
                              OSMESA_PROFILE,
                              OSMESA_CORE_PROFILE,
                              OSMESA_CONTEXT_MAJOR_VERSION,
                              4,
                              OSMESA_CONTEXT_MINOR_VERSION,
                              5,
                              0};
    context_ = osmesa().createContext(attributes, nullptr);
    if (context_ == nullptr) throwEnvironmentError("OSMesa offers no OpenGL 4.5 core context");
  }
  ~OsmesaContext() override { osmesa().destroyContext(context_); }

  void bind() override {
    if (osmesa().makeCurrent(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE)
      throwEnvironmentError("OSMesaMakeCurrent failed");
  }
  void unbind() override { osmesa().makeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  Function function(const char* name) const override { return osmesa().getProcAddress(name); }

 private:
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> pixel_{};  // OSMesa wants a default framebuffer, if only of one pixel
};

}  // namespace

std::unique_ptr<NativeContext> createOsmesaContext() { return std::make_unique<OsmesaContext>(); }
#else
std::unique_ptr<NativeContext> createOsmesaContext() {
  throwEnvironmentError("this build has no OSMesa backend (PROBEBENCH_OSMESA=OFF); use --gl egl");
}
#endif

}  // namespace pb::gl
