// Time of a piece of GL work: wall time between glFinish calls on software GL, a timer query on a GPU.
#pragma once

#include <chrono>

#include "raster/gl/objects.h"

namespace pb {

class PassTimer {
 public:
  PassTimer(const gl::Functions& gl, bool software);

  void start();
  double stopMs();  // waits for the work since start()

 private:
  const gl::Functions& gl_;
  bool software_;
  gl::Query query_;
  std::chrono::steady_clock::time_point started_;
};

}  // namespace pb
