#include "bench/clusters.h"

#include <gmock/gmock.h>

#include <cmath>

namespace pb {
namespace {

constexpr int kWidth = 40, kHeight = 30;  // radius 1; 5 % are 60 pixels

struct Errors {
  Image reference{kWidth, kHeight, glm::vec3(0.5f)};
  Image test = reference;
  Grid<int> objects{kWidth, kHeight, -1};

  // A squared error of `square`, in the red channel alone.
  void add(int x, int y, double square) { test(x, y).x += static_cast<float>(std::sqrt(square)); }
  std::vector<ErrorCluster> clusters() const { return findClusters(reference, test, objects, {"ball", "wall"}); }
};

constexpr double kRounding = 1e-6;

TEST(Clusters, OfEqualImages_AreNone) { EXPECT_TRUE(Errors().clusters().empty()); }

// 4 + 4 + 1 + 1: the two pixels of 4 make up half of the sum; 3 apart, their squares of 3 pixels touch.
TEST(Clusters, JoinHighPixelsWhoseSquaresTouch) {
  Errors errors;
  errors.add(10, 5, 4);
  errors.add(13, 7, 4);
  errors.add(30, 20, 1);
  errors.add(5, 25, 1);
  errors.objects(10, 5) = errors.objects(13, 7) = 0;
  const auto clusters = errors.clusters();
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].x, 10);
  EXPECT_EQ(clusters[0].y, 5);
  EXPECT_EQ(clusters[0].width, 4);
  EXPECT_EQ(clusters[0].height, 3);
  EXPECT_EQ(clusters[0].pixels, 2);
  EXPECT_NEAR(clusters[0].share, 0.8, kRounding);
  EXPECT_EQ(clusters[0].object, "ball");
}

TEST(Clusters, FurtherApart_AreTwo_TheUpperOneFirst) {
  Errors errors;
  errors.add(14, 7, 4);
  errors.add(10, 5, 4);
  const auto clusters = errors.clusters();
  ASSERT_EQ(clusters.size(), 2u);  // pixels that equal the last one count: not only one of them
  EXPECT_EQ(clusters[0].y, 5);
  EXPECT_EQ(clusters[1].y, 7);
  EXPECT_EQ(clusters[0].share, clusters[1].share);
  EXPECT_EQ(clusters[0].object, "environment");
}

TEST(Clusters, AreTheFiveWithTheLargestShares) {
  Errors errors;
  for (int i = 0; i < 7; ++i) errors.add(5 * i, 10, 100 + i);
  errors.add(20, 25, 600);  // so that the seven are needed for half of the sum only down to the fourth
  const auto clusters = errors.clusters();
  EXPECT_LE(clusters.size(), kMostClusters);
  EXPECT_EQ(clusters[0].y, 25);
  for (std::size_t i = 1; i < clusters.size(); ++i) EXPECT_GE(clusters[i - 1].share, clusters[i].share);
}

// Every pixel is off by as much: all equal the last one that counts, and are one cluster.
TEST(Clusters, OfAnEvenError_AreTheWholeImage) {
  Errors errors;
  for (auto& pixel : errors.test) pixel.x += 0.25f;
  const auto clusters = errors.clusters();
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].pixels, kWidth * kHeight);
  EXPECT_NEAR(clusters[0].share, 1.0, kRounding);
}

// A ramp: half of the sum would take 30 % of the pixels, the largest 5 % are the last column and a half.
TEST(Clusters, HoldAtMostFivePercentOfThePixels) {
  Errors errors;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) errors.add(x, y, 1.0 + x + 0.01 * y);
  const auto clusters = errors.clusters();
  ASSERT_EQ(clusters.size(), 1u);
  EXPECT_EQ(clusters[0].pixels, 60);
  EXPECT_EQ(clusters[0].x, kWidth - 2);
}

}  // namespace
}  // namespace pb
