// What the parts of the report have in common: columns that are filled from the frames of a technique.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/sections.h"
#include "bench/tables.h"

namespace pb {

// Perceptual, and defined for scene-referred images: the error that the tables of one question show.
inline constexpr char kMainMetric[] = "flip_hdr";

// A column of a table with one row a technique, and how to fill it.
struct Quantity {
  Column column;
  std::function<std::string(const Sequence&)> text;
};

// Behind the axes that vary the quantities, one row a technique.
Table tableOfAll(const Section& section, const std::vector<Quantity>& quantities);

// Of a technique, with a mark where it is not clear of the reference's noise.
std::string meanErrorText(const Sequence& sequence, Region region, const std::string& metric);
std::string worstErrorText(const Sequence& sequence, Region region, const std::string& metric);

// Columns of FLIP-HDR and relMSE; with the 95th percentile and the worst frame where there are several.
void addErrors(std::vector<Quantity>& quantities, const Section& section, Region region);

bool hasCost(const Section& section);
// A quantity of the measured cost, "-" where none was measured.
Quantity costQuantity(const std::string& title, std::function<std::string(const CostResult&)> text);

// "0.98..1.02".
std::string intervalText(double low, double high);
// A mean over the frames: a whole number where every frame does the same.
std::string countText(double mean);

// The technique of smallest error by the main metric, in the region of the section; of several the cheapest.
const Sequence& bestOf(const Section& section);
// ", axis=value" of the axes that vary.
std::string axesText(const Section& section, const Sequence& sequence);

// --- Parts of a section, each with its headings; empty where there is nothing to tell

std::string questionsText(const Section& section);
std::string errorsText(const Section& section);
std::string objectsText(const Section& section);
std::string costsText(const Section& section);
std::string workText(const Section& section);
std::string externalText(const Section& section);

}  // namespace pb
