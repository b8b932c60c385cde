#include "scenes/numbering.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

namespace pb {
namespace {

// Far more keys than it was told, so that the table grows; with keys that come again.
TEST(Numbering, CountsKeysInTheOrderOfTheirFirstInsertion) {
  Numbering<std::array<int, 2>> numbering(4);
  std::map<std::array<int, 2>, std::uint32_t> expected;
  for (int i = 0; i < 20000; ++i) {
    const std::array<int, 2> key = {i * 7919 % 5003, i % 2};
    const std::uint32_t number = expected.try_emplace(key, static_cast<std::uint32_t>(expected.size())).first->second;
    ASSERT_EQ(numbering.numberOf(key), number);
  }
  EXPECT_EQ(numbering.size(), expected.size());
  for (const auto& [key, number] : expected) EXPECT_EQ(numbering.find(key), number);
}

TEST(Numbering, FindsNothingThatWasNotInserted) {
  Numbering<float> numbering;
  EXPECT_EQ(numbering.find(0.0f), std::nullopt);
  numbering.numberOf(0.0f);
  EXPECT_EQ(numbering.find(0.0f), 0u);
  EXPECT_EQ(numbering.find(-0.0f), std::nullopt);  // equal are bytes
}

}  // namespace
}  // namespace pb
