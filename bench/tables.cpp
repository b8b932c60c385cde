#include "bench/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>

#include "scenes/spec.h"

namespace pb {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : escapeMarkdown(text)) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

// Bytes of UTF-8 that do not continue a code point.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, Align align) {
  const std::string space(width - widthOf(text), ' ');
  return align == Align::left ? text + space : space + text;
}

std::string line(const std::vector<std::string>& cells) { return fmt::format("| {} |\n", fmt::join(cells, " | ")); }

}  // namespace

std::string escapeMarkdown(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i], next = i + 1 < text.size() ? text[i + 1] : ' ', last = i > 0 ? text[i - 1] : ' ';
    // An element begins with a letter, "</", "<!" or "<?" (CommonMark 0.31.2, section 6.6); "< 0.1" is none.
    const bool opensElement =
        c == '<' && (std::isalpha(static_cast<unsigned char>(next)) || next == '/' || next == '!' || next == '?');
    if (opensElement || c == '`' || (c == '(' && last == ']')) result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

std::string toMarkdown(const Table& table) {
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& column : table.columns) lines[0].push_back(escaped(column.title));
  for (const auto& row : table.rows) {
    assert(row.size() == table.columns.size());
    lines.emplace_back();
    std::ranges::transform(row, std::back_inserter(lines.back()), escaped);
  }

  std::vector<std::string> rule;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = 3;  // of the shortest rule that Markdown knows
    for (const auto& cells : lines) width = std::max(width, widthOf(cells[c]));
    for (auto& cells : lines) cells[c] = padded(cells[c], width, table.columns[c].align);
    rule.push_back(std::string(width - 1, '-') + (table.columns[c].align == Align::left ? '-' : ':'));
  }

  std::string text = line(lines[0]) + line(rule);
  for (std::size_t i = 1; i < lines.size(); ++i) text += line(lines[i]);
  return text;
}

std::string formatSignificant(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (value == 0 || std::isinf(value)) return fmt::format("{}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (exponent < -4 || exponent >= 6) return fmt::format("{:.{}e}", value, digits - 1);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
}

std::string formatUncertainty(const Estimate& estimate) {
  constexpr double kSameSides = 1.25;
  if (!estimate.isKnown()) return " (interval not known)";
  if (!(estimate.plusMinus() > 0)) return {};
  const double above = estimate.high - estimate.value, below = estimate.value - estimate.low;
  const std::string reach = formatSignificant(estimate.plusMinus(), 1);
  const auto printed = [](const std::string& number) { return parseNumber(number).value_or(0); };
  const bool holdsZero = !estimate.isNegative() && !estimate.isPositive();
  const bool seemsToHoldZero = std::abs(printed(formatSignificant(estimate.value))) <= printed(reach);
  if (std::max(above, below) <= kSameSides * std::min(above, below) && holdsZero == seemsToHoldZero)
    return " +- " + reach;
  return fmt::format(" [{}, {}]", formatSignificant(estimate.low), formatSignificant(estimate.high));
}

}  // namespace pb
