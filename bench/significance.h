// Whether two measured costs differ by more than chance: pure functions of numbers, the same on every machine.
#pragma once

#include <vector>

namespace pb {

// The cost of one sequence in one run, as a multiple of a plain frame's.
struct RatioSample {
  double median = 0, low = 0, high = 0;  // of frame times, with the 95 % interval of the median
  std::vector<double> ratios;            // CostResult::ratios by repetition; empty if not kept
};

// Whether both hold enough repetitions to be compared by them.
bool haveRepetitions(const RatioSample& a, const RatioSample& b);

// The median of the repetitions; if the two are not compared by them, that of the frame times.
double typicalRatio(const RatioSample& sample, bool byRepetitions);

// Two-sided probability of logarithms of ratios whose means are so far apart, if both costs were the same. From the
// repetitions by a circular block bootstrap (Politis and Romano 1992), since neighbouring repetitions share the state
// of the machine; where a side has fewer than three of them, from both intervals, taken as those of a normal
// distribution.
double equalCostProbability(const RatioSample& before, const RatioSample& after);

// Holm's step-down adjustment (1979): rejecting where the adjusted value is below alpha keeps the probability of any
// false rejection among all of them below alpha, whatever their dependence.
std::vector<double> holmAdjusted(const std::vector<double>& probabilities);

}  // namespace pb
