#include "scenes/spec.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "scenes/error.h"

namespace pb {
namespace {

// Levenshtein distance: insertions, deletions and substitutions cost 1.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

// Names beyond the twentieth are only counted.
std::string listOf(std::span<const std::string> names) {
  constexpr std::size_t kMostShown = 20;
  const auto shown = names.first(std::min(names.size(), kMostShown));
  std::string text;
  for (const std::string& name : shown) text += fmt::format("{}'{}'", text.empty() ? "" : ", ", name);
  return shown.size() == names.size() ? text : fmt::format("{} and {} more", text, names.size() - shown.size());
}

// Length of the value at the start of `rest`, which ends at the next '&' or, in parentheses, behind their end.
std::size_t valueLength(std::string_view rest) {
  int depth = 0;
  for (std::size_t i = 0; rest.starts_with('(') && i < rest.size(); ++i) {
    if (rest[i] == '(') ++depth;
    if (rest[i] == ')') --depth;
    if (depth == 0 && (i + 1 == rest.size() || rest[i + 1] == '&')) return i + 1;
    if (depth == 0) break;
  }
  return std::min(rest.find('&'), rest.size());
}

std::size_t parameterLength(std::string_view rest) {
  const std::size_t sign = rest.find_first_of("=&");
  if (sign == std::string_view::npos) return rest.size();
  return rest[sign] == '&' ? sign : sign + 1 + valueLength(rest.substr(sign + 1));
}

bool isInParentheses(std::string_view value) {
  return value.size() >= 2 && value.starts_with('(') && value.ends_with(')');
}

std::string withoutParentheses(std::string_view value) {
  return std::string(isInParentheses(value) ? value.substr(1, value.size() - 2) : value);
}

}  // namespace

Spec parseSpec(std::string_view text) {
  Spec spec;
  const std::size_t question = text.find('?');
  spec.name = text.substr(0, question);
  if (spec.name.empty()) throwInputError("a value needs a name before its parameters, got '{}'", text);
  if (question == std::string_view::npos) return spec;
  std::string_view rest = text.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = parameterLength(rest);
    const std::string_view pair = rest.substr(0, end);
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throwInputError("parameters are written name?key=value&key=value, got '{}' in '{}'", pair, text);
    std::string key(pair.substr(0, equals));
    if (std::ranges::any_of(spec.parameters, [&](const auto& p) { return p.first == key; }))
      throwInputError("parameter '{}' stands twice in '{}'", key, text);
    spec.parameters.emplace_back(std::move(key), withoutParentheses(pair.substr(equals + 1)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return spec;
}

std::string printSpec(const Spec& spec) {
  std::string text = spec.name;
  char separator = '?';
  for (const auto& [key, value] : spec.parameters) {
    const bool isAmbiguous = value.find('&') != std::string::npos || isInParentheses(value);
    text += separator + key + '=' + (isAmbiguous ? '(' + value + ')' : value);
    separator = '&';
  }
  return text;
}

const std::string* SpecReader::find(std::string_view key) {
  known_.emplace_back(key);
  for (std::size_t i = 0; i < spec_.parameters.size(); ++i)
    if (spec_.parameters[i].first == key) {
      used_[i] = true;
      return &spec_.parameters[i].second;
    }
  return nullptr;
}

int SpecReader::integer(std::string_view key, int minimum, int maximum, int otherwise) {
  const std::string* value = find(key);
  if (value == nullptr) return otherwise;
  const std::optional<long long> parsed = parseInteger(*value);
  if (!parsed || *parsed < minimum || *parsed > maximum)
    throwInputError("{}: parameter '{}' wants an integer from {} to {}, got '{}'", place_, key, minimum, maximum,
                    *value);
  return static_cast<int>(*parsed);
}

double SpecReader::number(std::string_view key, double minimum, double maximum, double otherwise) {
  const std::string* value = find(key);
  if (value == nullptr) return otherwise;
  const std::optional<double> parsed = parseNumber(*value);
  if (!parsed || *parsed < minimum || *parsed > maximum)
    throwInputError("{}: parameter '{}' wants a number from {} to {}, got '{}'", place_, key, minimum, maximum, *value);
  return *parsed;
}

std::string SpecReader::text(std::string_view key, std::string otherwise) {
  const std::string* value = find(key);
  return value != nullptr ? *value : std::move(otherwise);
}

std::optional<std::string> SpecReader::optionalText(std::string_view key) {
  const std::string* value = find(key);
  return value != nullptr ? std::optional(*value) : std::nullopt;
}

void SpecReader::finish() const {
  for (std::size_t i = 0; i < used_.size(); ++i)
    if (!used_[i]) throwInputError("{}: parameter {}", place_, unknownMessage(spec_.parameters[i].first, known_));
}

std::optional<long long> parseInteger(std::string_view text) {
  long long value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty() ? std::optional(value)
                                                                                   : std::nullopt;
}

std::optional<double> parseNumber(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value) ? std::optional(value)
                                                                                          : std::nullopt;
}

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
  const auto best =
      std::ranges::min_element(candidates, {}, [&](const std::string& c) { return editDistance(word, c); });
  return best == candidates.end() ? std::string() : *best;
}

std::string unknownMessage(std::string_view word, std::span<const std::string> candidates) {
  if (candidates.empty()) return fmt::format("'{}' is not known here; none is", word);
  const std::string best = nearest(word, candidates);
  if (editDistance(word, best) > std::max<std::size_t>(2, word.size() / 2))
    return fmt::format("'{}' is not known; known are {}", word, listOf(candidates));
  return fmt::format("'{}' is not known; nearest is '{}'", word, best);
}

}  // namespace pb
