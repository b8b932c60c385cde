#include "bench/suite_axes.h"

#include <algorithm>
#include <set>

#include "bench/axes.h"

namespace pb {
namespace {

// A list of values, or "*" alone.
GridAxis readGridAxis(const std::string& name, const toml::node& node, const std::string& file) {
  GridAxis axis{name, {}};
  std::vector<std::string>& values = axis.second;
  const auto add = [&](const toml::node& value) {
    const std::string text = scalarText(value, name, file);
    atPlace(file, value, [&] { appendAxisValues(name, text, values); });
    if (std::ranges::count(values, values.back()) > 1)
      throwInputError("{}: axis '{}' has the value {} twice", placeOf(file, value), name, values.back());
  };
  if (node.value<std::string>() == "*")
    add(node);
  else
    for (const toml::node& value : asArray(node, name, file)) add(value);
  if (axis.second.empty()) throwInputError("{}: axis '{}' has no values", placeOf(file, node), name);
  return axis;
}

// The axes that the reader's table names, and their values.
std::vector<GridAxis> readAxes(TomlReader& reader) {
  std::vector<GridAxis> axes;
  for (const Axis& axis : axisTable())
    if (const toml::node* node = reader.find(axis.name)) axes.push_back(readGridAxis(axis.name, *node, reader.file()));
  reader.finish();
  return axes;
}

std::vector<std::pair<std::string, std::string>> readSettings(TomlReader& owner, std::string_view key) {
  std::vector<std::pair<std::string, std::string>> settings;
  std::optional<TomlReader> reader = owner.child(key);
  if (!reader) return settings;
  for (const Axis& axis : axisTable())
    if (const toml::node* node = reader->find(axis.name)) {
      const std::string text = scalarText(*node, axis.name, owner.file());
      settings.emplace_back(axis.name,
                            atPlace(owner.file(), *node, [&] { return canonicalAxisValue(axis.name, text); }));
    }
  reader->finish();
  return settings;
}

Variation readVariation(const toml::table& table, const std::string& file) {
  TomlReader reader(table, file, "'vary'");
  Variation variation;
  variation.on = readSettings(reader, "on");
  variation.values = readAxes(reader);
  return variation;
}

}  // namespace

Technique readTechnique(TomlReader& suite) {
  Technique technique;
  for (const auto& [axis, value] : readSettings(suite, "technique")) setAxis(technique, axis, value);
  return technique;
}

std::vector<GridAxis> readAxes(TomlReader& owner, std::string_view key) {
  std::optional<TomlReader> reader = owner.child(key);
  return reader ? readAxes(*reader) : std::vector<GridAxis>{};
}

std::vector<Variation> readVariations(TomlReader& scene) {
  std::vector<Variation> variations;
  const toml::node* node = scene.find("vary");
  if (node == nullptr) return variations;
  if (!node->is_array()) return {readVariation(asTable(*node, "vary", scene.file()), scene.file())};
  for (const toml::node& variation : *node->as_array())
    variations.push_back(readVariation(asTable(variation, "vary", scene.file()), scene.file()));
  return variations;
}

std::vector<std::string> variedAxes(const std::vector<Variation>& variations) {
  std::set<std::string> named;
  for (const Variation& variation : variations) {
    for (const auto& [axis, value] : variation.on) named.insert(axis);
    for (const auto& [axis, values] : variation.values) named.insert(axis);
  }
  std::vector<std::string> axes;
  for (const Axis& axis : axisTable())
    if (named.contains(axis.name)) axes.push_back(axis.name);
  return axes;
}

std::string canonicalText(const std::string& scene, const Variation& variation) {
  std::string on;
  for (const auto& [axis, value] : variation.on) on += fmt::format(" on {}={}", axis, value);
  if (variation.values.empty()) return fmt::format("vary {}{}\n", scene, on);
  std::string text;
  for (const auto& [axis, values] : variation.values)
    text += fmt::format("vary {} {} = {}{}\n", scene, axis, fmt::join(values, ","), on);
  return text;
}

}  // namespace pb
