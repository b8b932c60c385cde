// Markdown tables whose columns are aligned as text too: one output for terminals and for reports.
#pragma once

#include <string>
#include <vector>

#include "bench/estimate.h"

namespace pb {

enum class Align { left, right };

struct Column {
  std::string title;
  Align align = Align::right;
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<std::string>> rows;  // each as long as `columns`
};

// A name in running text or in a heading of Markdown: what would begin an element of HTML, code or a link's target is
// escaped, line breaks become spaces. Names as the tool makes them stay as they are.
std::string escapeMarkdown(const std::string& text);

// Widths count Unicode code points; cells are escaped like names, and '|' as well. Ends with a line break.
std::string toMarkdown(const Table& table);

// `value` with that many significant digits: 0.0123, 12.3, 12345, and 1.23e-05 below 1e-4 or from a million on. "-" for
// NaN.
std::string formatSignificant(double value, int digits = 3);

// What follows a number to say how sure it is: "" if it is exact, " +- 0.002", " [0.0001, 0.0052]" where the interval's
// sides differ by more than a quarter or rounding would let it seem to hold 0 or not, " (interval not known)".
std::string formatUncertainty(const Estimate& estimate);

}  // namespace pb
