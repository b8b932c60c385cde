// The lines of .obj and .mtl files: one statement each.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string_view>
#include <vector>

namespace pb::obj {

std::string_view trimmed(std::string_view text);

std::vector<std::string_view> words(std::string_view line);

// Calls visit(line number, line without its end).
template <class Visit>
void forEachLine(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    visit(number, text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
  }
}

// Statements that consist of numbers, and how many there are at least.
using Statements = std::map<std::string_view, std::size_t>;
extern const Statements kObjNumbers, kMtlNumbers;

// Throw an input Error naming the line: tinyobjloader takes what is no number for 0.
void checkNumbers(std::string_view text, const Statements& statements);
void checkFaces(std::string_view text);

}  // namespace pb::obj
