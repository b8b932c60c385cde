#include "bench/metric_audit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/sample_results.h"

namespace pb {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

CellResult cellOf(const std::string& scene, const std::string& resolution, double flip, double relmse) {
  CellResult cell = samples::makeCell(scene, 0, resolution, "static", 0.1);
  cell.maskMetrics->flipHdr->mean = flip;
  cell.maskMetrics->sums.relmse = relmse;
  cell.maskFloor = {{"mse", 0}, {"relmse", 0}};  // no noise: all differences are exact
  return cell;
}

double tauOf(const MetricAudit& audit, const std::string& a, const std::string& b) {
  for (const MetricAgreement& agreement : audit.agreements)
    if (agreement.a == a && agreement.b == b) return agreement.tauB;
  return std::numeric_limits<double>::quiet_NaN();
}

// FLIP orders 1 2 3 4, relMSE 1 2 4 3: five of six pairs agree, (5 - 1) / 6.
TEST(MetricAudit, TauOfOneSwapOfFour_IsTwoThirds) {
  const std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 1.0), cellOf("a", "2", 0.2, 2.0),
                                         cellOf("a", "3", 0.3, 4.0), cellOf("a", "4", 0.4, 3.0)};
  const MetricAudit audit = auditMetrics(cells);
  EXPECT_EQ(audit.pairs, 6u);
  EXPECT_NEAR(tauOf(audit, "flip_hdr", "relmse"), 4.0 / 6.0, 1e-12);
  EXPECT_EQ(audit.disputed, 1u);
  ASSERT_THAT(audit.disputes, SizeIs(1));
  EXPECT_EQ(audit.disputes[0].byFlip, &cells[2]);
  EXPECT_EQ(audit.disputes[0].byRelmse, &cells[3]);
  EXPECT_NEAR(audit.disputes[0].flipFactor, 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(audit.disputes[0].relmseFactor, 4.0 / 3.0, 1e-12);
}

// Ties of FLIP leave 2 of 3 pairs, all agree: 2 / sqrt(2 * 3).
TEST(MetricAudit, Ties_AreThoseOfTauB) {
  const std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 1.0), cellOf("a", "2", 0.2, 2.0),
                                         cellOf("a", "3", 0.2, 3.0)};
  EXPECT_NEAR(tauOf(auditMetrics(cells), "flip_hdr", "relmse"), 2 / std::sqrt(6.0), 1e-12);
}

TEST(MetricAudit, WhatLiesWithinIntervals_IsATie) {
  std::vector<CellResult> cells = {cellOf("a", "1", 0.10, 2.0), cellOf("a", "2", 0.11, 1.0)};
  EXPECT_EQ(auditMetrics(cells).disputed, 1u);
  for (CellResult& cell : cells) cell.maskIntervals = {{"flip_hdr", {0.08, 0.13}}};
  const MetricAudit audit = auditMetrics(cells);
  EXPECT_EQ(audit.disputed, 0u);
  EXPECT_THAT(audit.disputes, IsEmpty());
}

// MAE orders the second pair oppositely, but against a reference with noise nobody knows by how much.
TEST(MetricAudit, WhatHasNoIntervalWhereThereIsNoise_IsLeftOut) {
  std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 1), cellOf("a", "2", 0.2, 2), cellOf("b", "1", 0.1, 1),
                                   cellOf("b", "2", 0.2, 2)};
  for (const std::size_t i : {0u, 3u}) cells[i].maskMetrics->sums.mae = 0.1;
  for (const std::size_t i : {1u, 2u}) cells[i].maskMetrics->sums.mae = 0.2;
  EXPECT_EQ(tauOf(auditMetrics(cells), "flip_hdr", "mae"), 0.0);
  for (const std::size_t i : {2u, 3u}) {
    cells[i].maskFloor = {{"relmse", 1e-6}};
    cells[i].maskIntervals = {{"flip_hdr", {cells[i].maskMetrics->flipHdr->mean, cells[i].maskMetrics->flipHdr->mean}}};
  }
  EXPECT_EQ(tauOf(auditMetrics(cells), "flip_hdr", "mae"), 1.0);
}

TEST(MetricAudit, ErrorsThatAreNearlyTheSame_AreNoDispute) {
  EXPECT_EQ(auditMetrics({cellOf("a", "1", 0.100, 2.0), cellOf("a", "2", 0.104, 1.0)}).disputed, 0u);
  EXPECT_EQ(auditMetrics({cellOf("a", "1", 0.100, 2.0), cellOf("a", "2", 0.106, 1.0)}).disputed, 1u);
}

TEST(MetricAudit, ComparesOnlyCellsOfOneSceneAndFrame) {
  const std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 2.0), cellOf("b", "2", 0.2, 1.0)};
  EXPECT_EQ(auditMetrics(cells).pairs, 0u);
  EXPECT_EQ(metricAuditText(auditMetrics(cells)), "");
}

TEST(MetricAudit, WhereMoreIsBetter_AgreementIsPositive) {
  std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 1.0), cellOf("a", "2", 0.2, 2.0)};
  cells[0].maskMetrics->ssim->mean = 0.9;
  cells[1].maskMetrics->ssim->mean = 0.8;
  EXPECT_EQ(tauOf(auditMetrics(cells), "flip_hdr", "ssim"), 1.0);
}

TEST(MetricAudit, EachCellStandsInOneDisputeOnly) {
  const std::vector<CellResult> cells = {cellOf("a", "1", 0.1, 9.0), cellOf("a", "2", 0.2, 4.0),
                                         cellOf("a", "3", 0.3, 3.0)};
  const MetricAudit audit = auditMetrics(cells);
  EXPECT_EQ(audit.disputed, 3u);
  EXPECT_THAT(audit.disputes, SizeIs(1));
}

TEST(MetricAuditText, NamesWhatTheDisputedCellsDifferIn) {
  const std::vector<CellResult> cells = {cellOf("a", "64", 0.1, 3.0), cellOf("a", "128", 0.2, 1.0)};
  const std::string text = metricAuditText(auditMetrics(cells));
  EXPECT_THAT(text, HasSubstr("FLIP-HDR and relMSE order 1 pair oppositely"));
  EXPECT_THAT(text, HasSubstr("resolution=64"));
  EXPECT_THAT(text, HasSubstr("resolution=128"));
}

}  // namespace
}  // namespace pb
