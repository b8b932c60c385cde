#include "bench/suite_attribution.h"

#include <regex>

namespace pb {
namespace {

constexpr int kMaxResolution = 4096;
constexpr int kMaxTexelSpp = 1024;

std::string readExpression(const toml::node& node, const std::string& file) {
  std::string text = scalarText(node, "cells", file);
  try {
    const std::regex expression(text);
  } catch (const std::regex_error&) {
    throwInputError("{}: 'cells' wants a regular expression, got '{}'", placeOf(file, node), text);
  }
  return text;
}

bool readEveryFrame(TomlReader& reader) {
  const std::optional<std::string> frames = reader.text("frames");
  if (frames && *frames != "last" && *frames != "all")
    throwInputError("{}: 'frames' of 'attribution' wants last or all, got '{}'",
                    placeOf(reader.file(), reader.require("frames")), *frames);
  return frames == "all";
}

}  // namespace

std::optional<AttributionSettings> readAttribution(TomlReader& suite) {
  std::optional<TomlReader> reader = suite.child("attribution");
  if (!reader) return std::nullopt;
  AttributionSettings settings;
  if (const toml::node* cells = reader->find("cells")) settings.cells = readExpression(*cells, suite.file());
  settings.everyFrame = readEveryFrame(*reader);
  if (const auto resolution = reader->integer("resolution", 8, kMaxResolution))
    settings.resolution = static_cast<int>(*resolution);
  if (const auto spp = reader->integer("spp", 2, kMaxTexelSpp)) {
    if (*spp % 2 != 0)
      throwInputError("{}: 'spp' wants an even number, got {}", placeOf(suite.file(), reader->require("spp")), *spp);
    settings.spp = static_cast<int>(*spp);
  }
  reader->finish();
  return settings;
}

std::string canonicalText(const std::optional<AttributionSettings>& settings) {
  if (!settings) return "";
  return fmt::format("attribution cells {} frames {} resolution {} spp {}\n", settings->cells.value_or("base"),
                     settings->everyFrame ? "all" : "last", settings->resolution, settings->spp.value_or(0));
}

}  // namespace pb
