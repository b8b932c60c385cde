// Certification: scenes whose picture is known in closed form, and the control in which nothing is approximated,
// rendered by both renderers. A number that probebench prints is worth as much as these checks.
//
// Adding one: a file in bench/certify/ and a line in the table of certify.cpp.
#pragma once

#include <string>
#include <vector>

#include "raster/renderer.h"

namespace pb {

// Passes when |measured - expected| <= tolerance. Errors are measured against an expected 0.
struct Check {
  std::string name;      // "two facing mirrors, simultaneous, 3 iterations"
  std::string subject;   // "raster", "reference" or "raster vs reference"
  std::string quantity;  // what is measured, with its unit
  double measured = 0.0;
  double expected = 0.0;
  double tolerance = 0.0;
  bool binding = true;  // false: printed for information, no verdict

  bool passed() const;  // false for NaN
};

struct Certificate {
  std::string name;
  std::string description;  // one sentence, with the source of the closed form
  std::vector<Check> (*run)(RasterDevice& device);
};

const std::vector<Certificate>& certificates();

// The control's scene of opaque objects: runs before every suite.
std::vector<Check> runControl(RasterDevice& device);

bool allPassed(const std::vector<Check>& checks);

// "passed" or the first failed binding check as one sentence.
std::string summary(const std::vector<Check>& checks);

// Markdown table: check, subject, quantity, measured, expected, tolerance, verdict.
std::string toMarkdown(const std::vector<Check>& checks);

}  // namespace pb
