// The techniques of a run as choices: error, cost and memory of each, over the scenes that a question is about.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/estimate.h"
#include "bench/results.h"
#include "bench/sections.h"

namespace pb {

struct Selection {
  std::string metric = "flip_hdr";
  std::optional<Region> region;  // none: the mask on scenes that have one
  std::string scenes;            // regular expression searched in the scenes' names; empty: all
  std::string object;            // errors of this object or material alone; empty: of the region
  bool worstFrame = false;       // in place of the mean over the frames
};

struct Candidate {
  AxisValues technique;
  Estimate loss;                              // smaller is better, see lossOf()
  std::string worstScene;                     // where the loss is largest
  std::optional<Estimate> ratio;              // frame over plain frame, of the scene where it is largest
  std::optional<Estimate> frameMs;            // likewise
  double probeBytes = 0;                      // likewise
  bool clearOfFloor = true;                   // in the frames that the loss is of
  std::vector<const CellResult*> worstCells;  // frames of the worst scene
  Region region = Region::whole;              // of that scene
  int worstFrame = 0;                         // of these, where the error is largest: the first of several
};

struct CandidateSet {
  Selection selection;                // that they were asked for by
  std::vector<Candidate> candidates;  // measured on all scenes, in the order of the run
  std::vector<std::string> scenes;
  std::vector<VaryingAxis> axes;  // in which the candidates differ
  AxisValues common;              // of these axes, what more than half of the candidates have
  std::size_t elsewhere = 0;      // techniques that were measured on some of the scenes only
  bool onMask = false;            // some errors are of the mask
};

// Of a number at each measured frame. The interval of a mean is the mean of the intervals: what is wrong with one
// frame's reference may be wrong with all of them alike. Frames of which none is known take it from those of which one
// is. `frames` must not be empty.
Estimate meanOverFrames(const std::vector<Estimate>& frames);

// The value where less is better, its negative where more is, its amount for "bias".
double lossOf(const std::string& metric, double value);
// Its inverse: the metric of a loss ("bias": its amount).
double metricOfLoss(const std::string& metric, double loss);

// Error of one cell as the selection asks for it: with its interval if the results have one, exact if the reference has
// no noise, else unknown, as are the errors of single objects then; nullopt where it is undefined or the object is not
// in sight.
std::optional<Estimate> lossOf(const CellResult& cell, const Selection& selection, Region region);

// Throws input Errors for an unknown metric, a pattern that is no regular expression or matches no scene, and an object
// that no scene shows. The cells must outlive the result.
CandidateSet candidatesOf(const Results& results, const Selection& selection);
// Of these sections, whatever their names; those of the selection's scenes and object are not looked for.
CandidateSet candidatesOf(const std::vector<Section>& sections, const Selection& selection);

// "resolution=128 bounces=2": what a candidate has of the axes in which they differ, without what is common; a preset
// speaks for all of its settings.
std::string techniqueText(const AxisValues& technique, const CandidateSet& set);

}  // namespace pb
