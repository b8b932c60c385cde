#include "bench/axes.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "bench/commands/commands.h"
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

int printAxis(const std::string& name) {
  const Axis& axis = axisNamed(name);
  fmt::print("{}", printList({{"axis", axis.name},
                              {"values", axis.values},
                              {"default", defaultOf(axis)},
                              {"meaning", axis.description},
                              {"source", axis.source}}));
  if (axis.name != "refresh") return 0;
  for (const RefreshPolicy& policy : refreshPolicies())
    fmt::print("\n{}", printList({{"value", policy.name},
                                  {"parameters", policy.parameters.empty() ? "none" : policy.parameters},
                                  {"meaning", policy.description},
                                  {"source", policy.source}}));
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
