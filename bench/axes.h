// Technique axes: the settings of the approximation by name, as suites, --set, results and tables know them.
//
// Adding one: a member of Technique and a line in the table of axis_table.cpp.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "raster/technique.h"

namespace pb {

struct Axis {
  std::string name;
  std::string values;  // as messages state them: "powers of two from 8 to 4096"
  std::string description;
  std::string source;                                          // who does it like that
  bool (*parse)(std::string_view text, Technique& technique);  // false: not one of the values
  std::string (*print)(const Technique& technique);            // canonical spelling; parse() reads it back
  std::vector<std::string> names = {};  // of all values, without parameters; none if they are numbers
};

// In the order of columns and keys.
const std::vector<Axis>& axisTable();

// Throws an input Error that names the nearest axis.
const Axis& axisNamed(std::string_view name);

// Throws an input Error: "axis 'resolution' wants powers of two from 8 to 4096, got 100".
void setAxis(Technique& technique, std::string_view axis, std::string_view value);

// The canonical spelling of a value of an axis; throws as setAxis() does.
std::string canonicalAxisValue(std::string_view axis, std::string_view value);

// Appends a value in its canonical spelling. "*" appends every name of the axis that none of the values has, with its
// parameters' defaults: an input Error if they are numbers.
void appendAxisValues(std::string_view axis, std::string_view text, std::vector<std::string>& values);

// Every axis with its value, in the table's order.
std::vector<std::pair<std::string, std::string>> describe(const Technique& technique);

// Splits "AXIS=V1,V2.." into the axis and its canonical values; an input Error if it is not
// written like that.
std::pair<std::string, std::vector<std::string>> parseAxisValues(std::string_view text);

}  // namespace pb
