// What rendering a frame costs, gathered while its passes go by.
#pragma once

#include <vector>

#include "raster/gl/objects.h"
#include "raster/pass_timer.h"
#include "raster/renderer.h"

namespace pb {

struct FrameWork {
  FrameCounters counters{};
  std::vector<FrameCounters> afterIteration{};  // `counters` as each bounce iteration left them
  PassTimes times{};
  PassTimer* timer = nullptr;                    // null: times stay 0
  const gl::Functions* fragmentCount = nullptr;  // null: FrameCounters::fragments stays 0

  // Runs a pass; its time in milliseconds.
  template <class Pass>
  double timed(const Pass& pass) {
    if (timer != nullptr) timer->start();
    pass();
    return timer != nullptr ? timer->stopMs() : 0.0;
  }

  // Runs passes whose fragments count, and waits for them if they do. Not one within another.
  template <class Passes>
  void counted(const Passes& passes) {
    if (fragmentCount == nullptr) return passes();
    const gl::Query query = gl::makeQuery(*fragmentCount, GL_SAMPLES_PASSED);
    fragmentCount->BeginQuery(GL_SAMPLES_PASSED, query.id());
    passes();
    fragmentCount->EndQuery(GL_SAMPLES_PASSED);
    counters.fragments += static_cast<std::int64_t>(gl::queryResult(query));
  }
};

}  // namespace pb
