// Reads a TOML table key by key, with messages that name file and line; the twin of SpecReader for suites.
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/error.h"

namespace pb {

// Where a node stands: "suites/quick.toml:12".
std::string placeOf(const std::string& file, const toml::node& node);

// Calls `action` and puts the node's place before the message of an input Error that it throws.
template <class Action>
auto atPlace(const std::string& file, const toml::node& node, Action&& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}", placeOf(file, node), error.what()));
  }
}

class TomlReader {
 public:
  // `what` names the table in messages: "the suite", "'image'".
  TomlReader(const toml::table& table, std::string file, std::string what)
      : table_(table), file_(std::move(file)), what_(std::move(what)) {}

  const toml::table& table() const { return table_; }
  const std::string& file() const { return file_; }

  // The node of a key, nullptr if it is absent; the key counts as known from then on.
  const toml::node* find(std::string_view key);
  const toml::node& require(std::string_view key);

  std::optional<std::string> text(std::string_view key);
  std::optional<long long> integer(std::string_view key, long long minimum, long long maximum);
  std::optional<double> number(std::string_view key, double minimum, double maximum);
  // The table of a key as a reader of its own.
  std::optional<TomlReader> child(std::string_view key);

  // Throws an input Error naming the first key that nobody asked for and the nearest known one.
  void finish() const;

 private:
  const toml::table& table_;
  std::string file_;
  std::string what_;
  std::vector<std::string> known_;
};

// The node as a table, or an input Error "'key' wants a table".
const toml::table& asTable(const toml::node& node, std::string_view key, const std::string& file);
const toml::array& asArray(const toml::node& node, std::string_view key, const std::string& file);

// A string, integer or number as text, as it would stand on the command line.
std::string scalarText(const toml::node& node, std::string_view key, const std::string& file);

}  // namespace pb
