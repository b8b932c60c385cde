// The command that measures one technique of a run again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "bench/recommend.h"
#include "bench/shell_word.h"

namespace pb {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view(".^$|()[]{}*+?\\").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

bool hasSetting(const AxisValues& technique, const std::pair<std::string, std::string>& setting) {
  return std::ranges::find(technique, setting) != technique.end();
}

// The fewest settings (greedily) that no other technique of the run has all of; in the technique's order.
AxisValues tellingSettings(const Results& results, const AxisValues& technique) {
  std::set<AxisValues> others;
  for (const CellResult& cell : results.cells)
    if (cell.technique != technique) others.insert(cell.technique);
  std::set<std::size_t> telling;
  while (!others.empty()) {
    const auto remaining = [&](const auto& setting) {
      return std::ranges::count_if(others, [&](const AxisValues& other) { return hasSetting(other, setting); });
    };
    const auto best = std::ranges::min_element(technique, {}, remaining);
    if (best == technique.end() || remaining(*best) == std::ssize(others)) break;  // nothing tells the rest apart
    telling.insert(static_cast<std::size_t>(best - technique.begin()));
    std::erase_if(others, [&](const AxisValues& other) { return !hasSetting(other, *best); });
  }
  AxisValues settings;
  for (const std::size_t i : telling) settings.push_back(technique[i]);
  return settings;
}

// Of CellResult::key().
std::string keyExpression(const AxisValues& settings, const std::vector<std::string>& scenes) {
  std::vector<std::string> names, parts;
  for (const std::string& scene : scenes) names.push_back(escaped(scene));
  for (const auto& [axis, value] : settings) parts.push_back(fmt::format("{}={}", axis, escaped(value)));
  std::string expression;
  if (!names.empty())
    expression = names.size() == 1 ? fmt::format("^scene={} camera=", names.front())
                                   : fmt::format("^scene=({}) camera=", fmt::join(names, "|"));
  if (parts.empty()) return expression;
  if (!expression.empty()) expression += ".*";
  return expression + fmt::format(" {}( |$)", fmt::join(parts, " (.* )?"));
}

}  // namespace

std::string rerunCommand(const Results& results, const AxisValues& technique, const std::vector<std::string>& scenes) {
  const auto& settings = results.provenance.settings;
  const auto command = std::ranges::find(settings, kCommandSetting, [](const auto& setting) { return setting.first; });
  std::string text =
      command == settings.end() ? "probebench run " + shellWord(results.provenance.suiteName) : command->second;
  std::set<std::string> all;
  for (const CellResult& cell : results.cells) all.insert(cell.scene);
  const std::set<std::string> chosen(scenes.begin(), scenes.end());
  const std::string expression =
      keyExpression(tellingSettings(results, technique), chosen == all ? std::vector<std::string>() : scenes);
  if (!expression.empty()) text += " --only " + shellWord(expression);
  return text + " --out out/answer";
}

}  // namespace pb
