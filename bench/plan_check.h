// What is sure to fail is refused before anything is rendered.
#pragma once

#include "bench/plan.h"
#include "bench/runner.h"
#include "bench/suite.h"
#include "raster/renderer.h"

namespace pb {

// Throws the input Errors with which a technique would refuse its scene.
void checkPlan(const Suite& suite, const Scenes& scenes, const Plan& plan, RasterDevice& device);

// Throws if the program of an external technique can't be found or a picture that was made earlier is not there.
void requireExternals(const Suite& suite, const Scenes& scenes, const Plan& plan);

}  // namespace pb
