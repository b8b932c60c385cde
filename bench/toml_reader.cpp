#include "bench/toml_reader.h"

#include <algorithm>

#include "scenes/spec.h"

namespace pb {

std::string placeOf(const std::string& file, const toml::node& node) {
  return fmt::format("{}:{}", file, node.source().begin.line);
}

const toml::node* TomlReader::find(std::string_view key) {
  known_.emplace_back(key);
  return table_.get(key);
}

const toml::node& TomlReader::require(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) throwInputError("{}: {} needs a key '{}'", placeOf(file_, table_), what_, key);
  return *node;
}

std::optional<std::string> TomlReader::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) throwInputError("{}: '{}' wants a string", placeOf(file_, *node), key);
  return node->value<std::string>();
}

std::optional<long long> TomlReader::integer(std::string_view key, long long minimum, long long maximum) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::string given = scalarText(*node, key, file_);
  const std::optional<long long> value = node->is_integer() ? parseInteger(given) : std::nullopt;
  if (!value || *value < minimum || *value > maximum)
    throwInputError("{}: '{}' wants an integer from {} to {}, got {}", placeOf(file_, *node), key, minimum, maximum,
                    given);
  return value;
}

std::optional<double> TomlReader::number(std::string_view key, double minimum, double maximum) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !(*value >= minimum && *value <= maximum))
    throwInputError("{}: '{}' wants a number from {:g} to {:g}, got {}", placeOf(file_, *node), key, minimum, maximum,
                    scalarText(*node, key, file_));
  return value;
}

std::optional<TomlReader> TomlReader::child(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return TomlReader(asTable(*node, key, file_), file_, fmt::format("'{}'", key));
}

void TomlReader::finish() const {
  for (const auto& [key, node] : table_)
    if (std::ranges::find(known_, key.str()) == known_.end())
      throwInputError("{}:{}: key {}", file_, key.source().begin.line, unknownMessage(key.str(), known_));
}

const toml::table& asTable(const toml::node& node, std::string_view key, const std::string& file) {
  if (!node.is_table()) throwInputError("{}: '{}' wants a table {{ ... }}", placeOf(file, node), key);
  return *node.as_table();
}

const toml::array& asArray(const toml::node& node, std::string_view key, const std::string& file) {
  if (!node.is_array()) throwInputError("{}: '{}' wants a list [ ... ]", placeOf(file, node), key);
  return *node.as_array();
}

std::string scalarText(const toml::node& node, std::string_view key, const std::string& file) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto integer = node.value_exact<int64_t>()) return std::to_string(*integer);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  throwInputError("{}: '{}' wants a string or a number", placeOf(file, node), key);
}

}  // namespace pb
