// What every metric asks of its input; violations are input Errors.
#pragma once

#include "bench/metrics/metrics.h"
#include "scenes/image.h"

namespace pb {

// Equal, non-zero sizes and finite values.
void requireComparable(const Image& reference, const Image& test);

// Non-zero size and finite values; `name` is for the message.
void requireFinite(const Image& image, const char* name);

// The mask's size is that of the images. An empty mask is the caller's business.
void requireMaskSize(const Mask& mask, int width, int height);

[[noreturn]] void throwEmptyMask(const Mask& mask);

}  // namespace pb
