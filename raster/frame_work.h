// What rendering a frame costs, gathered while its passes go by.
#pragma once

#include "raster/pass_timer.h"
#include "raster/renderer.h"

namespace pb {

struct FrameWork {
  FrameCounters counters{};
  PassTimes times{};
  PassTimer* timer = nullptr;  // null: times stay 0

  // Runs a pass; its time in milliseconds.
  template <class Pass>
  double timed(const Pass& pass) {
    if (timer != nullptr) timer->start();
    pass();
    return timer != nullptr ? timer->stopMs() : 0.0;
  }
};

}  // namespace pb
