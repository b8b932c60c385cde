#include "bench/external_technique.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameLength = 40;
constexpr int kMaxTimeoutS = 7 * 24 * 3600;
constexpr int kMaxDigits = 9;

bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("._-").find(c) != std::string_view::npos;
}

std::string readName(TomlReader& reader) {
  const toml::node& node = reader.require("name");
  std::string name = reader.text("name").value();
  if (name.empty() || name.size() > kMaxNameLength || !std::ranges::all_of(name, isNameCharacter))
    throwInputError("{}: 'name' wants 1 to {} letters, digits, points, hyphens or underscores, got '{}'",
                    placeOf(reader.file(), node), kMaxNameLength, name);
  return name;
}

// Without a slash at its end; `folder` is empty for a suite in the current one.
fs::path absoluteFolder(const std::string& folder) {
  const fs::path absolute = (fs::current_path() / folder).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

std::string inFolder(const std::string& path, const std::string& folder) {
  return (absoluteFolder(folder) / path).lexically_normal().string();
}

std::string replaced(std::string text, std::string_view placeholder, const std::string& value) {
  for (std::size_t at = 0; (at = text.find(placeholder, at)) != std::string::npos; at += value.size())
    text.replace(at, placeholder.size(), value);
  return text;
}

std::vector<std::string> readCommand(const toml::node& node, const std::string& file, const std::string& folder) {
  const std::string suiteFolder = absoluteFolder(folder).string();
  std::vector<std::string> command;
  for (const toml::node& argument : asArray(node, "command", file)) {
    if (!argument.is_string()) throwInputError("{}: 'command' wants strings", placeOf(file, argument));
    const std::string written = argument.value<std::string>().value();
    command.push_back(replaced(written, "{suite}", suiteFolder));
  }
  if (command.empty() || command.front().empty())
    throwInputError("{}: 'command' wants a program and its arguments", placeOf(file, node));
  if (command.front().find('/') != std::string::npos) command.front() = inFolder(command.front(), folder);
  return command;
}

// On one line, members sorted by name.
std::string jsonOf(const toml::table& table) {
  std::ostringstream text;
  text << toml::json_formatter(table, toml::format_flags::none);
  return text.str();
}

// {frame} and {frame:05}: the width, 0 for none; `end` is behind the brace. nullopt for anything else.
std::optional<int> frameWidth(const std::string& pattern, std::size_t at, std::size_t& end) {
  constexpr std::string_view kOpen = "{frame";
  if (pattern.compare(at, kOpen.size(), kOpen) != 0) return std::nullopt;
  end = pattern.find('}', at);
  if (end == std::string::npos) return std::nullopt;
  const std::string_view format = std::string_view(pattern).substr(at + kOpen.size(), end - at - kOpen.size());
  ++end;
  if (format.empty()) return 0;
  const std::optional<long long> width = format.starts_with(":0") ? parseInteger(format.substr(2)) : std::nullopt;
  if (!width || *width < 1 || *width > kMaxDigits) return std::nullopt;
  return static_cast<int>(*width);
}

// Refuses placeholders that there aren't.
std::string readPattern(TomlReader& reader, const char* key, const std::string& folder) {
  const std::optional<std::string> pattern = reader.text(key);
  if (!pattern) return {};
  const std::string filled = pictureFile(*pattern, {});
  if (filled.find_first_of("{}") != std::string::npos)
    throwInputError("{}: '{}' knows {{scene}}, {{camera}}, {{number}}, {{frame}} and {{frame:05}}, got '{}'",
                    placeOf(reader.file(), *reader.find(key)), key, *pattern);
  return inFolder(*pattern, folder);
}

// A command makes the pictures and times that the other keys are about.
void requireOneSource(TomlReader& reader, const ExternalTechnique& technique) {
  const bool runs = !technique.command.empty();
  if (runs == !technique.images.empty())
    throwInputError("{}: external technique '{}' wants either 'command' or 'images'",
                    placeOf(reader.file(), reader.table()), technique.name);
  for (const char* key : {"timing", "timeout_s", "settings"}) {
    const bool ofCommand = std::string_view(key) != "timing";
    if (runs != ofCommand && reader.find(key) != nullptr)
      throwInputError("{}: '{}' belongs to an external technique with '{}'",
                      placeOf(reader.file(), reader.require(key)), key, ofCommand ? "command" : "images");
  }
}

ExternalTechnique readTechnique(const toml::table& table, const std::string& file, const std::string& folder) {
  TomlReader reader(table, file, "an [[external]]");
  ExternalTechnique technique;
  technique.name = readName(reader);
  if (const toml::node* command = reader.find("command")) technique.command = readCommand(*command, file, folder);
  technique.images = readPattern(reader, "images", folder);
  technique.timing = readPattern(reader, "timing", folder);
  technique.timeoutS = static_cast<int>(reader.integer("timeout_s", 1, kMaxTimeoutS).value_or(technique.timeoutS));
  if (const toml::node* settings = reader.find("settings"))
    technique.settings = jsonOf(asTable(*settings, "settings", file));
  requireOneSource(reader, technique);
  reader.finish();
  toml::table written = table;
  written.erase("timeout_s");
  technique.canonical = jsonOf(written);
  return technique;
}

}  // namespace

std::vector<ExternalTechnique> readExternalTechniques(TomlReader& suite, const std::string& folder) {
  std::vector<ExternalTechnique> techniques;
  const toml::node* node = suite.find("external");
  if (node == nullptr) return techniques;
  for (const toml::node& table : asArray(*node, "external", suite.file())) {
    techniques.push_back(readTechnique(asTable(table, "external", suite.file()), suite.file(), folder));
    if (std::ranges::count(techniques, techniques.back().name, &ExternalTechnique::name) > 1)
      throwInputError("{}: external technique '{}' stands twice", placeOf(suite.file(), table), techniques.back().name);
  }
  return techniques;
}

std::string pictureFile(const std::string& pattern, const PictureName& name) {
  std::string file;
  for (std::size_t at = 0; at < pattern.size();) {
    const auto take = [&](std::string_view placeholder, const std::string& value) {
      if (pattern.compare(at, placeholder.size(), placeholder) != 0) return false;
      file += value;
      at += placeholder.size();
      return true;
    };
    std::size_t end = 0;
    if (take("{scene}", name.scene) || take("{camera}", name.camera) || take("{number}", std::to_string(name.number)))
      continue;
    if (const std::optional<int> width = frameWidth(pattern, at, end)) {
      file += fmt::format("{:0{}}", name.frame, *width);
      at = end;
    } else {
      file += pattern[at++];
    }
  }
  return file;
}

}  // namespace pb
