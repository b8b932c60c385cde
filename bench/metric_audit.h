// Do the metrics agree on which technique is better? Pairs of techniques on the same scene, camera and frame are
// ordered by each metric as verdictOf() has it; pairs whose difference is within its 95 % interval, or below the floor,
// are ties. A pair is left out for metrics whose noise is not known, unless their values are equal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/results.h"

namespace pb {

// Of two metrics over all pairs: Kendall's tau-b (Kendall, "The treatment of ties in ranking problems", Biometrika
// 33(3), 1945), (C - D) / sqrt((P - Ta) (P - Tb)) with C pairs that both order alike, D oppositely, Ta and Tb ties of P
// pairs of which both know the order: 1 is full agreement, 0 none, -1 the opposite. NaN where one of them orders
// nothing.
struct MetricAgreement {
  std::string a, b;
  double tauB = 0;
};

// Two cells of which FLIP calls the first better and relMSE the second, both by 5 % at least.
struct MetricDispute {
  const CellResult* byFlip = nullptr;
  const CellResult* byRelmse = nullptr;
  double flipFactor = 1, relmseFactor = 1;  // by which the other's error is larger
};

struct MetricAudit {
  std::vector<std::string> metrics;         // that order at least one pair
  std::vector<MetricAgreement> agreements;  // of each two of them, in their order
  std::size_t pairs = 0;                    // that were compared
  std::size_t disputed = 0;                 // by FLIP and relMSE
  std::vector<MetricDispute> disputes;      // the largest first, by the smaller of the two factors; each cell once
};

// At most `disputes` disputes are listed. The cells must outlive the result.
MetricAudit auditMetrics(const std::vector<CellResult>& cells, std::size_t disputes = 5);

// A section of the report: "" where no pair was compared.
std::string metricAuditText(const MetricAudit& audit);

}  // namespace pb
