#include "scenes/obj/statements.h"

#include "scenes/error.h"
#include "scenes/spec.h"

namespace pb::obj {
namespace {

bool isNumber(std::string_view word) { return parseNumber(word.starts_with('+') ? word.substr(1) : word).has_value(); }

}  // namespace

const Statements kObjNumbers = {{"v", 3}, {"vn", 3}, {"vt", 1}};
const Statements kMtlNumbers = {{"Ka", 1}, {"Kd", 1}, {"Ks", 1}, {"Ke", 1}, {"Tf", 1}, {"Ns", 1},
                                {"Ni", 1}, {"d", 1},  {"Tr", 1}, {"Pm", 1}, {"Pr", 1}, {"illum", 1}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> result;
  for (line = trimmed(line); !line.empty(); line = trimmed(line)) {
    const std::size_t length = std::min(line.find_first_of(" \t\r"), line.size());
    result.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
  return result;
}

void checkNumbers(std::string_view text, const Statements& statements) {
  forEachLine(text, [&](std::size_t number, std::string_view line) {
    std::vector<std::string_view> w = words(line);
    const auto found = w.empty() ? statements.end() : statements.find(w.front());
    if (found == statements.end()) return;
    const auto end = std::ranges::find_if(w, [](std::string_view word) { return word.starts_with('#'); });
    if (static_cast<std::size_t>(end - w.begin()) <= found->second || !std::all_of(w.begin() + 1, end, isNumber))
      throwInputError("line {}: '{}' wants {} or more finite numbers, got '{}'", number, w.front(), found->second,
                      trimmed(line));
  });
}

void checkFaces(std::string_view text) {
  forEachLine(text, [](std::size_t number, std::string_view line) {
    const std::vector<std::string_view> w = words(line);
    if (w.empty() || w.front() != "f") return;
    for (std::size_t i = 1; i < w.size() && !w[i].starts_with('#'); ++i)
      if (w[i].find_first_not_of("0123456789-/") != w[i].npos || w[i].starts_with('/'))
        throwInputError("line {}: faces consist of indices such as 1, 1/2, 1//3 or 1/2/3, got '{}'", number, w[i]);
  });
}

}  // namespace pb::obj
