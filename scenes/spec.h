// Values with parameters, written `name?k=v&k2=v2` everywhere: scenes, refresh policies, lookups. A value that has
// parameters itself stands in parentheses: `builtin:teapot?environment=(constant?r=1&g=2&b=3)`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pb {

struct Spec {
  std::string name;
  std::vector<std::pair<std::string, std::string>> parameters;  // in the order written

  friend bool operator==(const Spec&, const Spec&) = default;
};

// Throws an input Error for an empty name, a parameter without '=', an empty or a repeated key.
Spec parseSpec(std::string_view text);
std::string printSpec(const Spec& spec);

// Reads the parameters of a Spec one after the other; finish() refuses what nobody asked for.
class SpecReader {
 public:
  SpecReader(const Spec& spec, std::string place)
      : spec_(spec), place_(std::move(place)), used_(spec.parameters.size(), false) {}

  int integer(std::string_view key, int minimum, int maximum, int otherwise);
  double number(std::string_view key, double minimum, double maximum, double otherwise);
  std::string text(std::string_view key, std::string otherwise);
  std::optional<std::string> optionalText(std::string_view key);

  // Throws an input Error naming the first parameter that was never read, as unknownMessage() does.
  void finish() const;

 private:
  const std::string* find(std::string_view key);

  Spec spec_;
  std::string place_;
  std::vector<bool> used_;
  std::vector<std::string> known_;
};

// Whole-string conversions; nullopt for anything else, including trailing characters, overflow, NaN and infinities.
std::optional<long long> parseInteger(std::string_view text);
std::optional<double> parseNumber(std::string_view text);

// The candidate with the smallest edit distance to `word` (ties: the first), "" if there are none.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

// "'resolutoin' is not known; nearest is 'resolution'", or "...; known are 'a', 'b'" where none is near; used in every
// unknown-key message.
std::string unknownMessage(std::string_view word, std::span<const std::string> candidates);

}  // namespace pb
