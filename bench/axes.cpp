#include "bench/axes.h"

#include <algorithm>

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr std::string_view kEveryOtherName = "*";

std::vector<std::string> axisNames() {
  std::vector<std::string> names;
  for (const Axis& axis : axisTable()) names.push_back(axis.name);
  return names;
}

}  // namespace

const Axis& axisNamed(std::string_view name) {
  const auto axis = std::ranges::find(axisTable(), name, &Axis::name);
  if (axis == axisTable().end()) throwInputError("axis {}", unknownMessage(name, axisNames()));
  return *axis;
}

void setAxis(Technique& technique, std::string_view name, std::string_view value) {
  const Axis& axis = axisNamed(name);
  if (!axis.parse(value, technique)) throwInputError("axis '{}' wants {}, got {}", name, axis.values, value);
}

std::string canonicalAxisValue(std::string_view axis, std::string_view value) {
  Technique technique;
  setAxis(technique, axis, value);
  return axisNamed(axis).print(technique);
}

void appendAxisValues(std::string_view name, std::string_view text, std::vector<std::string>& values) {
  if (text != kEveryOtherName) return values.push_back(canonicalAxisValue(name, text));
  const Axis& axis = axisNamed(name);
  if (axis.names.empty())
    throwInputError("'{}' stands for an axis's names, axis '{}' wants {}", text, name, axis.values);
  for (const std::string& other : axis.names)
    if (std::ranges::none_of(values, [&](const std::string& value) { return parseSpec(value).name == other; }))
      values.push_back(canonicalAxisValue(name, other));
}

std::vector<std::pair<std::string, std::string>> describe(const Technique& technique) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const Axis& axis : axisTable()) values.emplace_back(axis.name, axis.print(technique));
  return values;
}

std::pair<std::string, std::vector<std::string>> parseAxisValues(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0)
    throwInputError("--set is written AXIS=VALUE or AXIS=VALUE,VALUE, got '{}'", text);
  std::pair<std::string, std::vector<std::string>> result{std::string(text.substr(0, equals)), {}};
  for (std::size_t begin = equals + 1; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    appendAxisValues(result.first, text.substr(begin, end - begin), result.second);
    if (std::ranges::count(result.second, result.second.back()) > 1)
      throwInputError("--set names value '{}' of axis '{}' twice", result.second.back(), result.first);
    begin = end + 1;
  }
  return result;
}

}  // namespace pb
