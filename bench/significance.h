// Whether two measured costs differ by more than chance: pure functions of numbers, the same on every machine.
#pragma once

#include <cstddef>
#include <vector>

namespace pb {

// Below, a test of two costs would see nothing but changes by factors.
inline constexpr std::size_t kFewestRepetitions = 6;

// Whether both hold enough repetitions (ratios to a plain frame) to be compared.
bool haveRepetitions(const std::vector<double>& a, const std::vector<double>& b);

// Two-sided probability of ratios so far apart if both costs were the same: Welch's t test of the logarithms. Exact
// enough at any count if they are normal and the repetitions independent; 1 without haveRepetitions().
double equalCostProbability(const std::vector<double>& before, const std::vector<double>& after);

// Holm's step-down adjustment (1979): rejecting where the adjusted value is below alpha keeps the probability of any
// false rejection among all of them below alpha, whatever their dependence.
std::vector<double> holmAdjusted(const std::vector<double>& probabilities);

}  // namespace pb
