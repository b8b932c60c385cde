// Texts as words of a command line that a person pastes into a POSIX shell.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace pb {

// The text itself where the shell takes it as it is, else in single quotes.
inline std::string shellWord(const std::string& text) {
  const auto isPlain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, isPlain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

}  // namespace pb
