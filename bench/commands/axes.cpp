#include "bench/axes.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/commands/commands.h"
#include "bench/presets.h"
#include "raster/lookup.h"
#include "raster/refresh.h"

namespace pb {
namespace {

std::string defaultOf(const Axis& axis) { return axis.print(Technique()); }

int listAxes() {
  std::vector<std::pair<std::string, std::string>> rows;
  for (const Axis& axis : axisTable())
    rows.emplace_back(axis.name, fmt::format("{} (default {})", axis.values, defaultOf(axis)));
  fmt::print("{}", printList(rows));
  return 0;
}

void printValue(const std::string& name, const std::string& parameters, const std::string& description,
                const std::string& source) {
  fmt::print("\n{}", printList({{"value", name},
                                {"parameters", parameters.empty() ? "none" : parameters},
                                {"meaning", description},
                                {"source", source}}));
}

void printPresets() {
  for (const Preset& preset : presets()) {
    std::string settings;
    for (const auto& [axis, value] : preset.settings) settings += (settings.empty() ? "" : " ") + axis + "=" + value;
    fmt::print("\n{}", printList({{"value", preset.name},
                                  {"settings", settings},
                                  {"meaning", preset.description},
                                  {"source", preset.source}}));
  }
}

int printAxis(const std::string& name) {
  const Axis& axis = axisNamed(name);
  fmt::print("{}", printList({{"axis", axis.name},
                              {"values", axis.values},
                              {"default", defaultOf(axis)},
                              {"meaning", axis.description},
                              {"source", axis.source}}));
  if (axis.name == "preset") printPresets();
  if (axis.name == "refresh")
    for (const RefreshPolicy& p : refreshPolicies()) printValue(p.name, p.parameters, p.description, p.source);
  if (axis.name == "lookup")
    for (const Lookup& l : lookups()) printValue(l.name, l.parameters, l.description, l.source);
  return 0;
}

}  // namespace

void addAxesCommand(CLI::App& app, const GlobalOptions&, Action& action) {
  CLI::App* axes = app.add_subcommand("axes", "settings of the approximation: values, defaults, sources");
  axes->require_subcommand(1);
  axes->add_subcommand("list", "all axes")->callback([&action] { action = listAxes; });
  CLI::App* info = axes->add_subcommand("info", "one axis in full");
  const auto name = std::make_shared<std::string>();
  info->add_option("AXIS", *name, "its name")->required();
  info->callback([&action, name] { action = [name] { return printAxis(*name); }; });
}

}  // namespace pb
