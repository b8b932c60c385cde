#include "bench/progress.h"

#include <gtest/gtest.h>

namespace pb {
namespace {

TEST(Duration, IsPrintedInTheLargestUnitNeeded) {
  EXPECT_EQ(printDuration(0), "0:00");
  EXPECT_EQ(printDuration(59.4), "0:59");
  EXPECT_EQ(printDuration(59.6), "1:00");
  EXPECT_EQ(printDuration(3599), "59:59");
  EXPECT_EQ(printDuration(3723), "1:02:03");
  EXPECT_EQ(printDuration(-1), "0:00");
}

TEST(ProgressBar, GuessesTheTimeLeftFromTheStepsDone) {
  // 8 of 32 in 10 s: 24 more at 1.25 s each.
  EXPECT_EQ(printBar("cost", 8, 32, 10), "[#######-----------------------]  25 %  cost 8/32, 0:30 left");
}

TEST(ProgressBar, AtBothEnds_HasNoTimeLeft) {
  EXPECT_EQ(printBar("cost", 0, 4, 0), "[------------------------------]   0 %  cost 0/4");
  EXPECT_EQ(printBar("cost", 4, 4, 9), "[##############################] 100 %  cost 4/4");
  EXPECT_EQ(printBar("cost", 0, 0, 0), "[##############################] 100 %  cost 0/0");
}

}  // namespace
}  // namespace pb
