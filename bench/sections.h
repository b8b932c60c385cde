// The cells of a run, grouped as the report's tables show them, and the numbers of a group.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

enum class Region { whole, mask };

// The frames of one technique on one scene; never empty.
using Sequence = std::vector<const CellResult*>;

struct VaryingAxis {
  std::string name;
  std::vector<std::string> values;  // in the order of the run
};

// Everything about one scene seen through one camera.
struct Section {
  std::vector<Sequence> sequences;  // of the program's own techniques; the axes are theirs
  std::vector<Sequence> externals;  // of external techniques; not both are empty
  std::vector<VaryingAxis> axes;    // those with more than one value
  std::vector<std::string> fixed;   // "axis=value" of the others
  Region region = Region::whole;    // where errors are of most interest: the mask, if there is one
  bool severalFrames = false;
};

// In the order of the run. The cells must outlive the sections.
std::vector<Section> sectionsOf(const std::vector<CellResult>& cells);

std::string axisValue(const Sequence& sequence, const std::string& axis);

// Of one cell; nullopt where it is undefined or not there.
std::optional<double> errorOf(const CellResult& cell, Region region, const std::string& metric);
std::optional<double> counterOf(const CellResult& cell, const std::string& name);
std::optional<double> faceAgeOf(const CellResult& cell);  // mean over all probes

// Over the frames; NaN where no frame has a value.
double meanError(const Sequence& sequence, Region region, const std::string& metric);
double largestError(const Sequence& sequence, Region region, const std::string& metric);
double meanCounter(const Sequence& sequence, const std::string& name);
double meanFaceAge(const Sequence& sequence);
double largestFaceAge(const Sequence& sequence);

// The multiple of a plain frame that breaks ties of errors; infinite where none was measured.
double costRank(const CellResult& cell);

// Whether the reference has no noise there, so that every error is exact. False where no floor is known.
bool isFreeOfNoise(const CellResult& cell, Region region);

// Whether the reference's noise makes up at most a tenth of the relMSE in every frame: against a noisy reference relMSE
// is on average the true one plus the floor. True where no floor is known.
bool isClearOfFloor(const Sequence& sequence, Region region);

}  // namespace pb
