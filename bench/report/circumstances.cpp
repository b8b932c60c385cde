#include "bench/report/circumstances.h"

#include <fmt/format.h>

#include "bench/tables.h"

namespace pb {
namespace {

using Circumstances = std::map<std::string, std::string>;

Circumstances circumstancesOf(const Results& results) {
  const Provenance& p = results.provenance;
  Circumstances all = {{"probebench", fmt::format("{} ({})", p.toolVersion, p.gitHash)},
                       {"suite", fmt::format("{} ({})", p.suiteName, p.suiteHash)},
                       {"CPU", fmt::format("{}, {} threads", p.cpu, p.threads)},
                       {"GL", fmt::format("{}: {}, {}", p.glBackend, p.glRenderer, p.glVersion)}};
  for (const auto& [name, value] : p.settings) all[name] = value;
  for (const auto& [scene, hash] : p.sceneHashes) all["scene " + scene] = hash;
  for (const auto& [name, version] : p.libraries) all[name] = version;
  for (const auto& [axis, values] : valuesByAxis(results))
    if (values.size() == 1) all["axis " + axis] = *values.begin();
  return all;
}

}  // namespace

ValuesByAxis valuesByAxis(const Results& results) {
  ValuesByAxis values;
  for (const CellResult& cell : results.cells)
    for (const auto& [axis, value] : cell.technique) values[axis].insert(value);
  return values;
}

std::string circumstancesText(const Results& before, const Results& after) {
  const Circumstances a = circumstancesOf(before), b = circumstancesOf(after);
  Circumstances names = a;
  names.insert(b.begin(), b.end());
  Table table{{{"circumstance", Align::left}, {"before", Align::left}, {"after", Align::left}}, {}};
  const auto text = [](const Circumstances& of, const std::string& name) {
    const auto found = of.find(name);
    return found == of.end() ? std::string("-") : found->second;
  };
  for (const auto& [name, value] : names)
    if (text(a, name) != text(b, name)) table.rows.push_back({name, text(a, name), text(b, name)});
  if (table.rows.empty()) return "Circumstances are the same.\n";
  return "Circumstances that differ:\n\n" + toMarkdown(table);
}

}  // namespace pb
