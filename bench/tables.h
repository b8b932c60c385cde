// Markdown tables whose columns are aligned as text too: one output for terminals and for reports.
#pragma once

#include <string>
#include <vector>

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

// Widths count Unicode code points; '|' and line breaks in a cell are escaped. Ends with a line break.
std::string toMarkdown(const Table& table);

// `value` with that many significant digits: 0.0123, 12.3, 12345, and 1.23e-05 below 1e-4 or from a million on. "-" for
// NaN.
std::string formatSignificant(double value, int digits = 3);

}  // namespace pb
