// How pictures travel in the report's page. That the page unpacks them rightly is checked in a browser
// (report_page_test.py).
#include <gtest/gtest.h>
#include <zlib.h>

#include <limits>

#include "bench/report/packed_picture.h"

namespace pb {
namespace {

std::string inflated(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  uLongf written = size;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &written, reinterpret_cast<const Bytef*>(packed.data()),
                       static_cast<uLong>(packed.size())),
            Z_OK);
  bytes.resize(written);
  return bytes;
}

// The residual of value i of `count`: low bytes first, then high bytes.
std::uint16_t residual(const std::string& bytes, std::size_t i, std::size_t count) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[i]) | static_cast<unsigned char>(bytes[count + i])
                                                                               << 8);
}

// The examples of RFC 4648, section 10.
TEST(Base64, Encodes_WhatTheStandardSays) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

// IEEE 754 binary16: 1 is 0x3C00, 0.5 is 0x3800, the largest number 0x7BFF, the smallest above 0 (2^-24) 0x0001.
TEST(HalfPlanes, RadianceOutOfRange_IsClamped) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Image image(2, 2);
  image[0] = {1.0f, 0.5f, 0.0f};
  image[1] = {-1.0f, nan, inf};
  image[2] = {1e9f, 65504.0f, 5.9604645e-8f};
  image[3] = {0.0f, -0.0f, -inf};
  EXPECT_EQ(halfPlanes(image), (std::vector<std::uint16_t>{0x3C00, 0, 0x7BFF, 0,  // R
                                                           0x3800, 0, 0x7BFF, 0,  // G
                                                           0, 0x7BFF, 0x0001, 0}));
}

TEST(PackedPicture, WithoutABase_IsPredictedFromTheLeft) {
  // Three planes of two rows of two.
  const std::vector<std::uint16_t> planes = {5, 7, 300, 1, 0, 0, 9, 9, 0x7BFF, 0, 1, 2};
  const std::string bytes = inflated(packPicture(planes, 2, {}), 24);
  ASSERT_EQ(bytes.size(), 24u);
  const std::vector<std::uint16_t> expected = {5, 2, 300, 65536 - 299, 0, 0, 9, 0, 0x7BFF, 0x8401, 1, 1};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(residual(bytes, i, 12), expected[i]) << i;
}

TEST(PackedPicture, WithABase_HasTheDifferences) {
  const std::vector<std::uint16_t> base = {5, 7, 300}, planes = {5, 6, 301};
  const std::string bytes = inflated(packPicture(planes, 1, base), 6);
  EXPECT_EQ(residual(bytes, 0, 3), 0);
  EXPECT_EQ(residual(bytes, 1, 3), 0xFFFF);
  EXPECT_EQ(residual(bytes, 2, 3), 1);
}

}  // namespace
}  // namespace pb
