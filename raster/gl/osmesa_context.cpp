#include "raster/gl/native_context.h"
#include "scenes/error.h"

#ifdef PROBEBENCH_OSMESA
#include <GL/osmesa.h>

#include <array>
#endif

namespace pb::gl {

#ifdef PROBEBENCH_OSMESA
namespace {

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
    context_ = OSMesaCreateContextAttribs(attributes, nullptr);
    if (context_ == nullptr) throwEnvironmentError("OSMesa offers no OpenGL 4.5 core context");
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }

  void bind() override {
    if (OSMesaMakeCurrent(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE)
      throwEnvironmentError("OSMesaMakeCurrent failed");
  }
  void unbind() override { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }
  Function function(const char* name) const override { return OSMesaGetProcAddress(name); }

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
