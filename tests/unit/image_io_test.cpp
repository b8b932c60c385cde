// Image files: values, orientation, encodings, damage, atomic writes.
#include "scenes/image_io.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <filesystem>

#include "scenes/error.h"
#include "scenes/files.h"

namespace pb {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Every pixel differs from every other.
Image makeRamp(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image(x, y) = {0.25f * static_cast<float>(x), static_cast<float>(y), -1.5f};
  return image;
}

LoadedImage readBytes(const std::string& bytes) { return readImage(std::as_bytes(std::span(bytes)), "test image"); }

Failure failureOf(const std::function<void()>& action, std::string* message = nullptr) {
  try {
    action();
  } catch (const Error& e) {
    if (message != nullptr) *message = e.what();
    return e.kind();
  }
  ADD_FAILURE() << "no Error was thrown";
  return Failure::verdict;
}

TEST(Exr, WrittenAndRead_KeepsEveryBitAndRow) {
  const Image image = makeRamp(7, 5);
  const LoadedImage loaded = readBytes(encodeExr(image));
  EXPECT_EQ(loaded.encoding, Encoding::linear);
  EXPECT_EQ(rgbOf(loaded.pixels), image);
  EXPECT_EQ(loaded.pixels(0, 0).w, 1.0f);
}

TEST(Exr, HoldsNoTimeOfDay_SoThatEqualPicturesAreEqualBytes) {
  const std::string bytes = encodeExr(makeRamp(7, 5));
  const std::string attribute("capDate\0string\0", 15);  // name, type, then the size of the text in four bytes
  const std::size_t at = bytes.find(attribute);
  EXPECT_TRUE(at == std::string::npos || bytes.compare(at + attribute.size(), 4, std::string(4, '\0')) == 0);
}

TEST(Exr, OfManyChannels_KeepsNamesAndValues) {
  const TemporaryFolder folder;
  const std::string path = folder.file("channels.exr");
  writeExr(path, {{"probe.age", Plane(3, 2, 4.5f)}, {"id", Plane(3, 2, 16777215.0f)}});
  const std::vector<NamedPlane> planes = readExrChannels(path);
  ASSERT_EQ(planes.size(), 2U);
  for (const auto& [name, plane] : planes) EXPECT_EQ(plane, Plane(3, 2, name == "id" ? 16777215.0f : 4.5f)) << name;
}

TEST(Pfm, StoresRowsBottomUp_AndIsReadTopDown) {
  const float bottomThenTop[] = {1.0f, 1.0f, 1.0f, 2.0f, 2.0f, 2.0f};
  std::string file = "PF\n1 2\n-1.0\n";
  file.append(reinterpret_cast<const char*>(bottomThenTop), sizeof bottomThenTop);
  const LoadedImage loaded = readBytes(file);
  EXPECT_EQ(loaded.encoding, Encoding::linear);
  EXPECT_EQ(loaded.pixels(0, 0).x, 2.0f);
  EXPECT_EQ(loaded.pixels(0, 1).x, 1.0f);
}

TEST(Png, OfEightBits_GivesTheNearestFloatToEachStep) {
  ImageRgba steps(256, 1);
  for (int i = 0; i < 256; ++i) steps(i, 0) = glm::vec4(glm::vec3(static_cast<float>(i) / 255.0f), 1.0f);
  const LoadedImage loaded = readBytes(encodePng(steps, 8));
  EXPECT_EQ(loaded.encoding, Encoding::srgb);
  EXPECT_EQ(loaded.pixels, steps);
}

TEST(Png, OfSixteenBits_IsOffByHalfAStepAtMost) {
  ImageRgba image(100, 1);
  for (int i = 0; i < 100; ++i) image(i, 0) = {static_cast<float>(i) / 99.0f, 0.1f, 0.9f, 1.0f};
  const LoadedImage loaded = readBytes(encodePng(image, 16));
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(loaded.pixels(i, 0).x, image(i, 0).x, 0.5001 / 65535.0);
}

TEST(Png, WithAlpha_KeepsItStraight) {
  const LoadedImage loaded = readBytes(encodePng(ImageRgba(2, 2, {1.0f, 0.4f, 0.0f, 0.2f}), 8));
  EXPECT_EQ(loaded.pixels(1, 1), glm::vec4(1.0f, 0.4f, 0.0f, 0.2f));
}

TEST(Png, OfLinearValues_IsClampedAndEncoded) {
  const TemporaryFolder folder;
  const std::string path = folder.file("image.png");
  writePng(path, Image(1, 1, {0.5f, 7.0f, -1.0f}));
  // IEC 61966-2-1: 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354, times 255 = 187.52, rounded 188.
  EXPECT_EQ(readImage(path).pixels(0, 0), glm::vec4(188.0f / 255.0f, 1.0f, 0.0f, 1.0f));
}

TEST(Png, OfNaN_IsBlack) {
  ImageRgba image(1, 1, {std::nanf(""), 1.0f, 0.0f, 1.0f});
  EXPECT_EQ(readBytes(encodePng(image, 8)).pixels(0, 0).x, 0.0f);
}

TEST(Srgb, DecodeInvertsEncode) {
  // Twice the rounding of float near 1; the curve's slope is at most 12.92.
  for (int i = 0; i <= 1000; ++i) {
    const float linear = static_cast<float>(i) / 1000.0f;
    EXPECT_NEAR(linearFromSrgb(srgbFromLinear(linear)), linear, 5e-7);
  }
}

TEST(ReadImage, GreyIsSpreadToRgb) {
  const LoadedImage loaded = readBytes("P5\n2 1\n255\n\x33\xff");
  EXPECT_EQ(loaded.pixels(0, 0), glm::vec4(0.2f, 0.2f, 0.2f, 1.0f));
  EXPECT_EQ(loaded.pixels(1, 0), glm::vec4(1.0f));
}

TEST(ReadImage, TruncatedAnywhere_IsRefused) {
  const Image image = makeRamp(40, 30);
  ImageRgba encoded(40, 30, {0.1f, 0.5f, 0.9f, 1.0f});
  for (const std::string& file : {encodeExr(image), encodePng(encoded, 8)})
    for (std::size_t percent = 0; percent < 100; percent += 3)
      EXPECT_THROW(readBytes(file.substr(0, file.size() * percent / 100)), Error) << percent << " % of " << file[1];
  const std::string png = encodePng(encoded, 8);
  EXPECT_THROW(readBytes(png.substr(0, png.size() - 1)), Error);
}

TEST(ReadImage, AbsurdDimensions_AreRefusedBeforeAllocation) {
  std::string message;
  EXPECT_EQ(failureOf([] { readBytes("PF\n1000000 1000000\n-1.0\n"); }, &message), Failure::input);
  EXPECT_THAT(message, HasSubstr("1000000 x 1000000"));
}

TEST(ReadImage, NoImage_IsRefusedByName) {
  std::string message;
  EXPECT_EQ(failureOf([] { readBytes("these are words"); }, &message), Failure::input);
  EXPECT_THAT(message, HasSubstr("test image"));
  EXPECT_EQ(failureOf([] { readImage("/nonexistent/image.png"); }, &message), Failure::input);
  EXPECT_THAT(message, HasSubstr("/nonexistent/image.png"));
}

TEST(WriteImage, ByExtension_OthersAreRefused) {
  const TemporaryFolder folder;
  const Image image(2, 2, glm::vec3(0.5f));
  writeImage(folder.file("a.EXR"), image);
  writeImage(folder.file("a.png"), image);
  EXPECT_EQ(rgbOf(readImage(folder.file("a.EXR")).pixels), image);
  EXPECT_EQ(failureOf([&] { writeImage(folder.file("a.gif"), image); }), Failure::input);
}

TEST(WriteImage, ToAFolderThatIsAbsent_IsAnEnvironmentError) {
  EXPECT_EQ(failureOf([] { writeExr("/nonexistent/a.exr", Image(1, 1)); }), Failure::environment);
}

// Limits the size of files that this process writes, as a full disk would.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(WriteImage, WhenTheDiskIsFull_LeavesNothingBehind) {
  const TemporaryFolder folder;
  Failure failure = Failure::verdict;
  {
    const FullDisk disk(100);
    failure = failureOf([&] { writeExr(folder.file("a.exr"), makeRamp(64, 64)); });
  }
  EXPECT_EQ(failure, Failure::environment);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace pb
