#include "bench/json_document.h"

#include <cmath>
#include <limits>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "results/schema/results.schema.h"
#include "scenes/error.h"

namespace pb {
namespace {

// The deepest legal place is a tolerance tree's leaf; a limit keeps hostile nesting from exhausting the stack of the
// recursive steps after parsing.
constexpr int kMaxDepth = 64;

// valijson reads the sorted flavour of nlohmann::json only.
using SortedJson = nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

Json parseJson(const std::string& text, const std::string& place) {
  const auto limitDepth = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth) throwInputError("JSON may be nested {} levels deep, '{}' is deeper", kMaxDepth, place);
    return true;
  };
  try {
    return Json::parse(text, limitDepth);
  } catch (const Json::parse_error& error) {
    if (error.byte > text.size())
      throwInputError("'{}' is truncated: its JSON ends too early, at byte {}", place, text.size());
    throwInputError("'{}' is not JSON: syntax error at byte {}", place, error.byte);
  } catch (const Json::out_of_range&) {
    throwInputError("'{}' holds a number that is too large for a double", place);
  }
}

// What else a document of this program is by its version key; empty for other JSON.
std::string_view otherKindOf(const Json& document) {
  constexpr std::pair<std::string_view, std::string_view> kKinds[] = {
      {"baseline_version", "a baseline"}, {"schema_version", "the results of a run"}, {"job_version", "a job"}};
  if (document.is_object())
    for (const auto& [key, kind] : kKinds)
      if (document.contains(key)) return kind;
  return "";
}

void requireVersion(const Json& document, const std::string& place, const DocumentFormat& format) {
  const bool isForeign = !document.is_object() || !document.contains(format.versionKey);
  if (const std::string_view kind = otherKindOf(document); isForeign && !kind.empty())
    throwInputError("'{}' is {}, not a {} file", place, kind, format.name);
  if (isForeign)
    throwInputError("'{}' is not a probebench {} file: it has no '{}'", place, format.name, format.versionKey);
  const Json& version = document.at(std::string(format.versionKey));
  if (version != format.version)
    throwInputError("'{}' has {} {}, this version of probebench reads {}", place, format.versionKey, printLine(version),
                    format.version);
}

// valijson's cache confuses the definitions of several documents, so those that are referred to in results.schema.json
// are moved into the one document that it sees.
SortedJson bundled(std::string schema) {
  constexpr std::string_view kOtherFile = "results.schema.json#";
  for (std::size_t at; (at = schema.find(kOtherFile)) != std::string::npos;) schema.replace(at, kOtherFile.size(), "#");
  SortedJson document = SortedJson::parse(schema);
  const SortedJson shared = SortedJson::parse(schemas::kResults);
  document["definitions"].update(shared.at("definitions"));
  return document;
}

// valijson's context is "<root>", "[cells]", "[0]", ...
Json::json_pointer pointerOf(const std::vector<std::string>& context) {
  Json::json_pointer pointer;
  for (std::size_t i = 1; i < context.size(); ++i) pointer /= context[i].substr(1, context[i].size() - 2);
  return pointer;
}

std::string abbreviated(std::string text) {
  constexpr std::size_t kMaxLength = 60;
  if (text.size() <= kMaxLength) return text;
  return text.substr(0, kMaxLength) + "...";
}

void requireSchema(const Json& document, const std::string& place, std::string_view schemaText) {
  const SortedJson schemaDocument = bundled(std::string(schemaText));
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(schemaDocument), schema);
  const SortedJson sorted = document;
  valijson::Validator validator(valijson::Validator::kStrongTypes);
  valijson::ValidationResults errors;
  if (validator.validate(schema, Adapter(sorted), &errors)) return;

  // The first is the innermost; those after it say that what contains it is wrong as well.
  const valijson::ValidationResults::Error& error = *errors.begin();
  const Json::json_pointer pointer = pointerOf(error.context);
  std::string rule = error.description;
  if (rule.ends_with('.')) rule.pop_back();
  throwInputError("'{}' breaks its schema at {}: {}, got {}", place, pointer.empty() ? "/" : pointer.to_string(), rule,
                  abbreviated(printLine(document.at(pointer))));
}

}  // namespace

Json parseDocument(const std::string& text, const std::string& place, const DocumentFormat& format) {
  Json document = parseJson(text, place);
  requireVersion(document, place, format);
  requireSchema(document, place, format.schema);
  return document;
}

Json parsePart(const std::string& text, const std::string& place, std::string_view schema) {
  Json part = parseJson(text, place);
  requireSchema(part, place, schema);
  return part;
}

std::string printDocument(const Json& head, std::string_view rowsKey, const std::vector<Json>& rows) {
  std::string text = head.dump(2, ' ', false, Json::error_handler_t::replace);
  text.resize(text.rfind("\n}"));
  text += fmt::format(",\n  \"{}\": [", rowsKey);
  const char* separator = "\n    ";
  for (const Json& row : rows) {
    text += separator + printLine(row);
    separator = ",\n    ";
  }
  return text + (rows.empty() ? "]\n}\n" : "\n  ]\n}\n");
}

std::string printLine(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json encodeNumber(double value) {
  if (std::isnan(value)) return nullptr;
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

double decodeNumber(const Json& value) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (value.is_string()) return value == "inf" ? kInfinity : -kInfinity;
  return value.get<double>();
}

}  // namespace pb
