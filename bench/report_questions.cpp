// Tables of one question: rows are one axis, columns another, the rest is fixed.
#include "bench/report_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "scenes/spec.h"

namespace pb {
namespace {

// Where an axis stands while others are varied: at its largest number, or else at its first value.
std::string standingValue(const VaryingAxis& axis) {
  const auto number = [](const std::string& value) { return parseNumber(value); };
  if (!std::ranges::all_of(axis.values, [&](const std::string& value) { return number(value).has_value(); }))
    return axis.values.front();
  return *std::ranges::max_element(axis.values, {}, number);
}

using Assignment = std::map<std::string, std::string>;  // axis -> value

std::string textAt(const Section& section, const Assignment& place, const Quantity& quantity) {
  const auto matches = [&](const Sequence& sequence) {
    return std::ranges::all_of(place,
                               [&](const auto& entry) { return axisValue(sequence, entry.first) == entry.second; });
  };
  const auto found = std::ranges::find_if(section.sequences, matches);
  return found == section.sequences.end() ? "-" : quantity.text(*found);
}

struct Question {
  const VaryingAxis& rows;
  const VaryingAxis* columns;  // null if only one axis varies
  Assignment fixed;
};

Question questionAbout(const Section& section, std::size_t axis) {
  Question question{section.axes[axis], nullptr, {}};
  if (section.axes.size() > 1) question.columns = &section.axes[(axis + 1) % section.axes.size()];
  for (const VaryingAxis& other : section.axes)
    if (&other != &question.rows && &other != question.columns) question.fixed[other.name] = standingValue(other);
  return question;
}

Table questionTable(const Section& section, const Question& question, const Quantity& quantity) {
  const VaryingAxis single{"", {quantity.column.title}};
  const VaryingAxis& columns = question.columns ? *question.columns : single;
  Table table{{{question.rows.name, Align::left}}, {}};
  for (const std::string& value : columns.values)
    table.columns.push_back({question.columns ? fmt::format("{}={}", columns.name, value) : value});
  for (const std::string& value : question.rows.values) {
    std::vector<std::string>& row = table.rows.emplace_back(1, value);
    Assignment place = question.fixed;
    place[question.rows.name] = value;
    for (const std::string& columnValue : columns.values) {
      if (question.columns) place[columns.name] = columnValue;
      row.push_back(textAt(section, place, quantity));
    }
  }
  return table;
}

std::string fixedText(const Assignment& fixed) {
  std::string text;
  for (const auto& [axis, value] : fixed) text += fmt::format(", {}={}", axis, value);
  return text;
}

Quantity mainError(const Section& section) {
  const Region region = section.region;
  const bool severalFrames = section.severalFrames;
  const std::string title = fmt::format("FLIP-HDR on the {}{}", region == Region::mask ? "mask" : "whole image",
                                        severalFrames ? ", mean over the frames (worst frame)" : "");
  return {{title}, [=](const Sequence& sequence) {
            const std::string mean = meanErrorText(sequence, region, kMainMetric);
            return severalFrames ? fmt::format("{} ({})", mean, worstErrorText(sequence, region, kMainMetric)) : mean;
          }};
}

Quantity mainCost() {
  Quantity quantity = costQuantity("", [](const CostResult& cost) { return formatSignificant(cost.ratio); });
  quantity.column.title = "frame time as a multiple of a plain frame";
  return quantity;
}

}  // namespace

std::string questionsText(const Section& section) {
  const Quantity error = mainError(section), cost = mainCost();
  std::string text;
  for (std::size_t i = 0; i < section.axes.size(); ++i) {
    const Question question = questionAbout(section, i);
    const auto add = [&](const char* what, const Quantity& quantity) {
      text += fmt::format("### {} versus {}\n\n{}{}\n\n{}\n", what, question.rows.name, quantity.column.title,
                          fixedText(question.fixed), toMarkdown(questionTable(section, question, quantity)));
    };
    add("Error", error);
    if (hasCost(section)) add("Cost", cost);
  }
  return text;
}

}  // namespace pb
