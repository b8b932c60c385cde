// Where the error lies in the picture of the technique of smallest error: by material, by object, in clusters.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "bench/report_parts.h"

namespace pb {
namespace {

constexpr std::size_t kShownObjects = 10;

std::string percentText(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

// The largest share first.
template <class Part>
std::vector<Part> byShare(std::vector<Part> parts) {
  std::ranges::stable_sort(parts, std::greater(), &Part::share);
  return parts;
}

Table materialTable(const CellResult& cell) {
  Table table{{{"material", Align::left}, {"pixels"}, {"share of squared error"}, {"FLIP-HDR"}, {"relMSE"}, {"bias"}},
              {}};
  for (const MaterialError& e : byShare(cell.materials))
    table.rows.push_back({e.material, fmt::format("{}", e.pixels), percentText(e.share), formatSignificant(e.flipHdr),
                          formatSignificant(e.relmse), formatSignificant(e.bias)});
  return table;
}

Table objectTable(const std::vector<ObjectError>& objects) {
  Table table{{{"object", Align::left},
               {"material", Align::left},
               {"pixels"},
               {"share"},
               {"FLIP-HDR"},
               {"relMSE"},
               {"bias"},
               {"probe"},
               {"distance m"},
               {"roughness"}},
              {}};
  for (const ObjectError& e : objects)
    table.rows.push_back({e.object, e.material, fmt::format("{}", e.pixels), percentText(e.share),
                          formatSignificant(e.flipHdr), formatSignificant(e.relmse), formatSignificant(e.bias),
                          e.probe ? std::to_string(*e.probe) : "-",
                          e.probeDistance ? formatSignificant(*e.probeDistance) : "-", formatSignificant(e.roughness)});
  return table;
}

std::string objectsOf(const CellResult& cell, const std::string& about) {
  std::vector<ObjectError> objects = byShare(cell.objects);
  if (objects.empty()) return {};
  const std::size_t all = objects.size();
  if (all > kShownObjects) objects.resize(kShownObjects);
  const std::string left =
      all > kShownObjects ? fmt::format("; the {} with the largest share of {}", kShownObjects, all) : "";
  return fmt::format("### Errors by object\n\n{}{}\n\n{}\n", about, left, toMarkdown(objectTable(objects)));
}

std::string clustersOf(const CellResult& cell, const std::string& about) {
  if (cell.clusters.empty()) return {};
  Table table{{{"object", Align::left}, {"share"}, {"pixels"}, {"left, top"}, {"size"}}, {}};
  for (const ErrorCluster& c : cell.clusters)
    table.rows.push_back({c.object, percentText(c.share), fmt::format("{}", c.pixels), fmt::format("{}, {}", c.x, c.y),
                          fmt::format("{} x {}", c.width, c.height)});
  return fmt::format("### Where the error sits together\n\n{}; in pixels\n\n{}\n", about, toMarkdown(table));
}

}  // namespace

std::string objectsText(const Section& section) {
  const Sequence& best = bestOf(section);
  const CellResult& cell = *best.back();
  const std::string about =
      fmt::format("frame {}, technique of the smallest error{}", cell.frame, axesText(section, best));
  std::string text;
  if (!cell.materials.empty())
    text += fmt::format("### Errors by material\n\n{}\n\n{}\n", about, toMarkdown(materialTable(cell)));
  return text + objectsOf(cell, about) + clustersOf(cell, about);
}

}  // namespace pb
