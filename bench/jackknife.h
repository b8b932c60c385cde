// Intervals of what is computed from a mean of batches: the delete-one jackknife (Efron and Stein, "The Jackknife
// Estimate of Variance", Annals of Statistics 9(3), 1981). Pure functions.
#pragma once

#include <span>
#include <vector>

#include "bench/results.h"
#include "scenes/image.h"

namespace pb {

// The 95 % interval of a number F of the mean of n >= 2 batches. replicates: F of the mean without each batch. Standard
// error: sqrt((n - 1) / n * sum (F_b - mean F_b)^2), Student's t with n - 1 degrees of freedom. Noise raises most
// errors: the jackknife's estimate of that bias, (n - 1) (mean F_b - F), is allowed for on its side, so that the
// interval holds both F and F without the bias.
Interval jackknifeInterval(double value, std::span<const double> replicates);

// The same of F_a - F_b, from replicates against the same batches in the same order: what the noise does to both alike
// cancels. So does their bias as far as they share it (of MSE all of it); what is left is allowed for as above, since
// noise raises a small error by more than a large one where errors are not squares (FLIP).
Interval jackknifeDifference(double a, std::span<const double> replicatesA, double b,
                             std::span<const double> replicatesB);

// The mean of all batches without one: (n mean - batch) / (n - 1).
Image leaveOneOut(const Image& mean, const Image& batch, std::size_t batches);

// Whether all batches are the same picture: then it has no noise.
bool areEqual(const std::vector<Image>& batches);

}  // namespace pb
