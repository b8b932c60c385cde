// JSON documents with a version and a schema: how results and baselines are read and written.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pb {

using Json = nlohmann::ordered_json;

struct DocumentFormat {
  std::string_view name;        // "results", for messages
  std::string_view versionKey;  // top-level key that tells the format from foreign JSON
  int version;
  std::string_view schema;
};

// Parses and checks against the schema. Throws a one-sentence input Error that names `place` and, where there is one,
// the JSON pointer: for text that is no JSON or ends too early, foreign JSON, other versions, and what the schema
// refuses.
Json parseDocument(const std::string& text, const std::string& place, const DocumentFormat& format);

// The same for a part of a document, which has no version of its own.
Json parsePart(const std::string& text, const std::string& place, std::string_view schema);

// `head` indented, then the array `rowsKey` with one row a line: readable, and diffs show the rows that changed.
std::string printDocument(const Json& head, std::string_view rowsKey, const std::vector<Json>& rows);

// On one line. Text that is no UTF-8 (names in glTF files) is shown with replacement characters.
std::string printLine(const Json& json);

// JSON has no infinities and no NaN: they are the strings "inf" and "-inf", and null.
Json encodeNumber(double value);
double decodeNumber(const Json& value);

}  // namespace pb
