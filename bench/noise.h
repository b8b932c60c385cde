// What the reference's remaining noise does to error figures: pure functions of its independent halves A and B.
#pragma once

#include "scenes/image.h"

namespace pb {

// mean((I-A)(I-B)) over pixels and channels: as A and B are independent and have the truth as their mean, its mean is
// the squared error of I against the truth, with no share of the noise. May come out negative.
double computeUnbiasedMse(const Image& image, const Image& a, const Image& b);

}  // namespace pb
