#include "bench/metric_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "bench/report_verdict.h"
#include "bench/tables.h"

namespace pb {
namespace {

constexpr const char* kFlip = "flip_hdr";
constexpr const char* kRelmse = "relmse";
// Those that are no functions of each other, of those that say how large an error is.
constexpr const char* kMetrics[] = {kFlip,   "flip_ldr", "ssim", "ms_ssim", kRelmse,
                                    "smape", "mae",      "mse",  "psnr",    "max_abs"};

// Errors nearer than this factor are the same for a reader, and no dispute.
constexpr double kSmallestFactor = 1.05;

// SSIM of five scales is not defined on a mask.
Region regionOf(const CellResult& cell, std::string_view metric) {
  return cell.maskMetrics && metric != "ms_ssim" ? Region::mask : Region::whole;
}

// -1: a is better, 1: b is, 0: neither; nullopt where it is not known or undefined.
std::optional<int> orderOf(const CellResult& a, const CellResult& b, const char* metric) {
  const std::optional<Verdict> verdict = knownVerdict(a, b, metric, regionOf(a, metric));
  if (!verdict) return std::nullopt;
  return *verdict == Verdict::better ? -1 : *verdict == Verdict::worse ? 1 : 0;
}

// Cells that answer the same question.
std::vector<std::vector<const CellResult*>> groupsOf(const std::vector<CellResult>& cells) {
  std::map<std::tuple<std::string, std::string, int>, std::size_t> places;
  std::vector<std::vector<const CellResult*>> groups;
  for (const CellResult& cell : cells) {
    const auto [place, isNew] = places.try_emplace({cell.scene, cell.camera, cell.frame}, groups.size());
    if (isNew) groups.emplace_back();
    groups[place->second].push_back(&cell);
  }
  return groups;
}

class Audit {
 public:
  void add(const std::vector<const CellResult*>& group) {
    for (std::size_t i = 0; i < group.size(); ++i)
      for (std::size_t j = i + 1; j < group.size(); ++j) add(*group[i], *group[j]);
  }

  MetricAudit result(std::size_t disputes) const {
    MetricAudit audit;
    audit.pairs = pairs_;
    audit.disputed = disputes_.size();
    for (std::size_t a = 0; a < kCount; ++a) {
      if (ordered_[a][a] == 0) continue;
      audit.metrics.emplace_back(kMetrics[a]);
      for (std::size_t b = a + 1; b < kCount; ++b)
        if (ordered_[a][b] > 0 && ordered_[b][a] > 0)
          audit.agreements.push_back({kMetrics[a], kMetrics[b], tauB(a, b)});
    }
    audit.disputes = largest(disputes);
    return audit;
  }

 private:
  static constexpr std::size_t kCount = std::size(kMetrics);
  static constexpr std::size_t kFlipIndex = 0, kRelmseIndex = 4;

  void add(const CellResult& a, const CellResult& b) {
    ++pairs_;
    std::optional<int> orders[kCount];
    for (std::size_t m = 0; m < kCount; ++m) orders[m] = orderOf(a, b, kMetrics[m]);
    for (std::size_t m = 0; m < kCount; ++m)
      for (std::size_t n = 0; n < kCount; ++n) {
        if (!orders[m] || !orders[n]) continue;
        if (*orders[m] != 0) ++ordered_[m][n];
        balance_[m][n] += *orders[m] * *orders[n];
      }
    const int byFlip = orders[kFlipIndex].value_or(0), byRelmse = orders[kRelmseIndex].value_or(0);
    if (byFlip * byRelmse < 0) addDispute(a, b, byFlip < 0);
  }

  double tauB(std::size_t a, std::size_t b) const {
    return static_cast<double>(balance_[a][b]) /
           std::sqrt(static_cast<double>(ordered_[a][b]) * static_cast<double>(ordered_[b][a]));
  }

  void addDispute(const CellResult& a, const CellResult& b, bool isABetterByFlip) {
    const auto factor = [&](const char* metric) {
      const double x = *errorOf(a, regionOf(a, metric), metric), y = *errorOf(b, regionOf(a, metric), metric);
      return std::max(x, y) / std::min(x, y);
    };
    const MetricDispute dispute{isABetterByFlip ? &a : &b, isABetterByFlip ? &b : &a, factor(kFlip), factor(kRelmse)};
    if (dispute.flipFactor >= kSmallestFactor && dispute.relmseFactor >= kSmallestFactor) disputes_.push_back(dispute);
  }

  std::vector<MetricDispute> largest(std::size_t count) const {
    std::vector<MetricDispute> sorted = disputes_;
    std::ranges::stable_sort(sorted, std::greater(),
                             [](const MetricDispute& d) { return std::min(d.flipFactor, d.relmseFactor); });
    std::vector<MetricDispute> chosen;
    std::set<const CellResult*> shown;
    for (const MetricDispute& dispute : sorted) {
      if (chosen.size() == count) break;
      if (shown.contains(dispute.byFlip) || shown.contains(dispute.byRelmse)) continue;
      // Techniques that do the same have the same disputes.
      if (std::ranges::any_of(chosen, [&](const MetricDispute& other) {
            return other.flipFactor == dispute.flipFactor && other.relmseFactor == dispute.relmseFactor;
          }))
        continue;
      shown.insert({dispute.byFlip, dispute.byRelmse});
      chosen.push_back(dispute);
    }
    return chosen;
  }

  std::size_t pairs_ = 0;
  // Of the pairs whose order both metrics know.
  std::size_t ordered_[kCount][kCount] = {};   // those that the first one orders: P - T
  std::int64_t balance_[kCount][kCount] = {};  // C - D
  std::vector<MetricDispute> disputes_;
};

Table agreementTable(const MetricAudit& audit) {
  Table table{{{"tau-b", Align::left}}, {}};
  for (std::size_t i = 1; i < audit.metrics.size(); ++i) table.columns.push_back({audit.metrics[i]});
  for (std::size_t i = 0; i + 1 < audit.metrics.size(); ++i) {
    std::vector<std::string>& row = table.rows.emplace_back(1, audit.metrics[i]);
    for (std::size_t j = 1; j < audit.metrics.size(); ++j) {
      const auto found = std::ranges::find_if(audit.agreements, [&](const MetricAgreement& agreement) {
        return agreement.a == audit.metrics[i] && agreement.b == audit.metrics[j];
      });
      row.push_back(found == audit.agreements.end() ? "" : fmt::format("{:.2f}", found->tauB));
    }
  }
  return table;
}

// Of the settings in which the two differ.
std::string settingsText(const CellResult& cell, const CellResult& other) {
  std::string text;
  for (std::size_t i = 0; i < cell.technique.size(); ++i)
    if (i >= other.technique.size() || cell.technique[i] != other.technique[i])
      text += fmt::format("{}{}={}", text.empty() ? "" : " ", cell.technique[i].first, cell.technique[i].second);
  return text;
}

Table disputeTable(const MetricAudit& audit) {
  Table table{{{"scene", Align::left},
               {"frame"},
               {"better by FLIP-HDR", Align::left},
               {"by factor"},
               {"better by relMSE", Align::left},
               {"by factor"}},
              {}};
  for (const MetricDispute& d : audit.disputes)
    table.rows.push_back({d.byFlip->scene, fmt::format("{}", d.byFlip->frame), settingsText(*d.byFlip, *d.byRelmse),
                          formatSignificant(d.flipFactor), settingsText(*d.byRelmse, *d.byFlip),
                          formatSignificant(d.relmseFactor)});
  return table;
}

}  // namespace

MetricAudit auditMetrics(const std::vector<CellResult>& cells, std::size_t disputes) {
  Audit audit;
  for (const auto& group : groupsOf(cells)) audit.add(group);
  return audit.result(disputes);
}

std::string metricAuditText(const MetricAudit& audit) {
  if (audit.metrics.size() < 2) return {};
  std::string text = fmt::format(
      "## Do the metrics agree?\n\n{} pairs of techniques on the same scene and frame, ordered by each metric (on the "
      "mask where there is one; MS-SSIM on the whole image). Kendall's tau-b: 1 where two metrics order all pairs "
      "alike, -1 where oppositely; pairs whose difference is within its 95 % interval or below the floor count as "
      "ties. "
      "Where the reference has noise, metrics without an interval (ms_ssim, mae, smape, psnr, max_abs) order "
      "nothing.\n\n{}\n",
      audit.pairs, toMarkdown(agreementTable(audit)));
  text += fmt::format("FLIP-HDR and relMSE order {} {} oppositely, by {:.0f} % or more in both{}\n\n", audit.disputed,
                      audit.disputed == 1 ? "pair" : "pairs", 100 * (kSmallestFactor - 1),
                      audit.disputes.empty() ? "." : ", most clearly these:");
  if (!audit.disputes.empty()) text += toMarkdown(disputeTable(audit)) + '\n';
  return text;
}

}  // namespace pb
