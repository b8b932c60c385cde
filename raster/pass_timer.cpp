#include "raster/pass_timer.h"

namespace pb {

PassTimer::PassTimer(const gl::Functions& gl, bool software) : gl_(gl), software_(software) {
  if (software_) return;
  query_ = gl::makeQuery(gl, GL_TIME_ELAPSED);
  // A context's first timer query is known to return garbage.
  start();
  stopMs();
}

void PassTimer::start() {
  if (!software_) return gl_.BeginQuery(GL_TIME_ELAPSED, query_.id());
  gl_.Finish();
  started_ = std::chrono::steady_clock::now();
}

double PassTimer::stopMs() {
  if (!software_) {
    gl_.EndQuery(GL_TIME_ELAPSED);
    return 1e-6 * static_cast<double>(gl::queryResult(query_));
  }
  gl_.Finish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started_).count();
}

}  // namespace pb
