#include "bench/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bench/mask.h"
#include "bench/truth.h"

namespace pb {
namespace {

constexpr int kWidth = 200, kHeight = 100;

// Truth 1 with independent normal noise of the given deviation in every channel.
Image noisyImage(unsigned seed, double deviation) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> noise(1.0f, static_cast<float>(deviation));
  Image image(kWidth, kHeight);
  for (glm::vec3& pixel : image) pixel = {noise(generator), noise(generator), noise(generator)};
  return image;
}

Image meanOfHalves(const Image& a, const Image& b) {
  Image mean(a.width(), a.height());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5f * (a[i] + b[i]);
  return mean;
}

TEST(UnbiasedMse, OfAConstantOffset_LeavesTheNoiseOut) {
  const double sigma = 0.1, offset = 0.05;
  const Image a = noisyImage(1, sigma), b = noisyImage(2, sigma);
  const Image image(kWidth, kHeight, glm::vec3(1.0f + static_cast<float>(offset)));
  // (I-A)(I-B) has mean offset^2 and variance sigma^4 + 2 offset^2 sigma^2: deviation 0.0122, of the mean over 60000
  // values 5e-5. The biased figure, mean((I-M)^2), would be offset^2 + sigma^2/2 = 0.0075 in place of 0.0025.
  EXPECT_NEAR(computeUnbiasedMse(image, a, b), offset * offset, 4 * 5e-5);
}

TEST(Floor, OfTwoHalves_IsAQuarterOfTheirMeanSquaredDifference) {
  const double sigma = 0.1;
  const Image a = noisyImage(3, sigma), b = noisyImage(4, sigma);
  const Image mean = meanOfHalves(a, b);
  double sum = 0, relative = 0;
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      const double d = a[i][channel] - b[i][channel], r = mean[i][channel];
      sum += d * d / 4;
      relative += d * d / 4 / (r * r + 0.01);
    }
  const double count = 3.0 * static_cast<double>(mean.size());
  const MetricValues floor = computeFloor(mean, a);
  // The mean image is rounded to float: A - M and (A-B)/2 differ by half an ulp of 1, 6e-8, against 0.07.
  EXPECT_NEAR(floor[0].second, sum / count, 1e-5 * sum / count);
  EXPECT_NEAR(floor[1].second, relative / count, 1e-5 * relative / count);
  EXPECT_NEAR(floor[0].second, sigma * sigma / 2, 4 * sigma * sigma / 2 * std::sqrt(2 / count));
}

TEST(SpecularMask, IsEveryPixelThatAnySampleOfEitherRendererShows) {
  const std::vector<unsigned char> specular = {0, 1};  // of two instances the second
  Grid<SampleId> raster(6, 4), reference(6, 4);        // 3 x 2 pixels of 2 x 2 samples
  raster(1, 1).instance = 2;                           // pixel 0,0: one sample of four
  raster(2, 0).instance = 1;                           // pixel 1,0: the diffuse instance
  reference(5, 3).instance = 2;                        // pixel 2,1
  Mask mask(3, 2);
  addPixelsOf(specular, raster, 2, mask);
  addPixelsOf(specular, reference, 2, mask);
  Mask expected(3, 2);
  expected(0, 0) = expected(2, 1) = 1;
  EXPECT_EQ(mask, expected);
}

}  // namespace
}  // namespace pb
