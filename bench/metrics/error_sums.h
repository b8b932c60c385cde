// Error sums of pictures that are known to be comparable, with the same results as computeErrorSums().
#pragma once

#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb {

ErrorSums errorSumsOf(const Image& reference, const Image& test, const Mask* mask);

// The same bits as errorSumsOf().psnr.
double psnrOf(const Image& reference, const Image& test, const Mask* mask);

}  // namespace pb
