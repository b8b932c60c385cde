#include "bench/suite_tolerance.h"

#include <algorithm>

#include "bench/metrics/metrics.h"
#include "scenes/spec.h"

namespace pb {
namespace {

constexpr double kMaxTolerance = 1e9;

Tolerance readTree(TomlReader& reader, const toml::node& node, const std::string& key);

Tolerance readBranch(Tolerance::Kind kind, const toml::node& node, const std::string& key, const std::string& file) {
  Tolerance tolerance;
  tolerance.kind = kind;
  for (const toml::node& child : asArray(node, key, file)) {
    TomlReader reader(asTable(child, key, file), file, fmt::format("the tolerance of '{}'", key));
    tolerance.children.push_back(readTree(reader, child, key));
    reader.finish();
  }
  if (tolerance.children.empty()) throwInputError("{}: '{}' has an empty list", placeOf(file, node), key);
  return tolerance;
}

Tolerance readTree(TomlReader& reader, const toml::node& node, const std::string& key) {
  if (const toml::node* any = reader.find("any")) return readBranch(Tolerance::Kind::any, *any, key, reader.file());
  if (const toml::node* all = reader.find("all")) return readBranch(Tolerance::Kind::all, *all, key, reader.file());
  const std::optional<double> relative = reader.number("relative", 0, kMaxTolerance);
  const std::optional<double> absolute = reader.number("absolute", 0, kMaxTolerance);
  if (!relative && !absolute)
    throwInputError("{}: the tolerance of '{}' wants relative, absolute, any or all", placeOf(reader.file(), node),
                    key);
  return {Tolerance::Kind::plain, absolute.value_or(0), relative.value_or(0), {}};
}

// nullopt: the metric's tolerance has no level `warn`.
std::optional<Tolerance> readWarning(TomlReader& metric, const std::string& key) {
  const toml::node* node = metric.find("warn");
  if (node == nullptr) return std::nullopt;
  TomlReader reader(asTable(*node, "warn", metric.file()), metric.file(), fmt::format("'warn' of '{}'", key));
  const Tolerance tolerance = readTree(reader, *node, key);
  reader.finish();
  return tolerance;
}

// Replaces both levels of the metric.
void readMetric(const toml::node& node, const std::string& key, const std::string& file, ToleranceLevels& levels) {
  const auto isKey = [&](const auto& pair) { return pair.first == key; };
  std::erase_if(levels.fail, isKey);
  std::erase_if(levels.warn, isKey);
  TomlReader reader(asTable(node, key, file), file, fmt::format("the tolerance of '{}'", key));
  levels.fail.emplace_back(key, readTree(reader, node, key));
  if (const std::optional<Tolerance> warning = readWarning(reader, key)) levels.warn.emplace_back(key, *warning);
  reader.finish();
}

ToleranceLevels readPreset(TomlReader& table) {
  const std::optional<std::string> name = table.text("preset");
  if (!name) return {};
  std::vector<std::string> names;
  for (const TolerancePreset& preset : tolerancePresets()) {
    if (preset.name == *name) return preset.levels;
    names.push_back(preset.name);
  }
  throwInputError("{}: preset {}", placeOf(table.file(), table.require("preset")), unknownMessage(*name, names));
}

// What may have a tolerance, in the order that files are written in.
std::vector<std::string> gatedKeys() {
  std::vector<std::string> keys;
  for (const MetricInfo& metric : metricTable()) keys.push_back(metric.key);
  keys.emplace_back(kIntegrityTolerance);
  return keys;
}

Tolerances inOrder(const Tolerances& tolerances) {
  Tolerances ordered;
  for (const std::string& key : gatedKeys())
    if (const Tolerance* tolerance = findTolerance(tolerances, key)) ordered.emplace_back(key, *tolerance);
  return ordered;
}

ToleranceLevels readLevels(TomlReader& table) {
  ToleranceLevels levels = readPreset(table);
  for (const std::string& key : gatedKeys())
    if (const toml::node* node = table.find(key)) readMetric(*node, key, table.file(), levels);
  table.finish();
  return {inOrder(levels.fail), inOrder(levels.warn)};
}

}  // namespace

ToleranceLevels readSuiteTolerances(TomlReader& suite) {
  std::optional<TomlReader> table = suite.child("tolerance");
  return table ? readLevels(*table) : ToleranceLevels();
}

ToleranceLevels readSceneTolerances(TomlReader& scene, const ToleranceLevels& ofSuite) {
  std::optional<TomlReader> table = scene.child("tolerance");
  if (!table) return {};
  ToleranceLevels levels = readLevels(*table);
  const auto isNotGated = [&](const auto& pair) { return findTolerance(ofSuite.fail, pair.first) == nullptr; };
  for (const auto& [metric, tolerance] : levels.fail)
    if (const toml::node* node = table->find(metric); node != nullptr && findTolerance(ofSuite.fail, metric) == nullptr)
      throwInputError("{}: a scene's tolerance wants a metric that [tolerance] has too, got '{}'",
                      placeOf(scene.file(), *node), metric);
  std::erase_if(levels.fail, isNotGated);
  std::erase_if(levels.warn, isNotGated);
  return levels;
}

}  // namespace pb
