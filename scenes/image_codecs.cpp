// The module that kImageCodecsFile names: nothing links it, and it alone includes OpenImageIO.
#include "scenes/image_codecs.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "scenes/error.h"

namespace pb {
namespace {

// Files that declare more than this (16384 x 16384) are refused before memory is allocated for them.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr int kMaxChannels = 64;

// OpenImageIO's messages may have several lines; ours have one.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

// An opened image in memory, already checked for sane dimensions.
class ImageReader {
 public:
  ImageReader(std::span<const std::byte> bytes, const std::string& format, const std::string& name)
      : name_(name), memory_(const_cast<std::byte*>(bytes.data()), bytes.size()) {
    input_ = OIIO::ImageInput::create(format);
    if (!input_) throwEnvironmentError("OpenImageIO on this machine has no reader for {} ('{}')", format, name);
    OIIO::ImageSpec configuration;
    configuration["oiio:UnassociatedAlpha"] = 1;
    OIIO::ImageSpec spec;
    if (!input_->set_ioproxy(&memory_) || !input_->open("memory." + format, spec, configuration)) fail();
    checkSpec();
  }

  const OIIO::ImageSpec& spec() const { return input_->spec(); }

  std::vector<float> readChannels(int channels) {
    const OIIO::ImageSpec& s = spec();
    std::vector<float> data(pixelCount(s.width, s.height) * static_cast<std::size_t>(channels));
    if (!input_->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, data.data()) || input_->has_error()) fail();
    roundToStoredSteps(data);
    const bool whole = s.x == s.full_x && s.y == s.full_y && s.width == s.full_width && s.height == s.full_height;
    if (whole) return data;
    return placeInDisplayWindow(data, channels);
  }

 private:
  static std::size_t pixelCount(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  [[noreturn]] void fail() {
    const std::string reason = firstLine(input_->geterror());
    throwInputError("image '{}' can't be decoded: {}", name_, reason.empty() ? "it is damaged" : reason);
  }

  void checkSpec() {
    const OIIO::ImageSpec& s = spec();
    if (s.deep || s.depth > 1) throwInputError("flat images are wanted, '{}' is deep or volumetric", name_);
    for (const auto& [width, height] : {std::pair(s.width, s.height), std::pair(s.full_width, s.full_height)})
      if (width < 1 || height < 1 || std::int64_t{width} * height > kMaxPixels)
        throwInputError("images of 1 to {} pixels are read, '{}' declares {} x {}", kMaxPixels, name_, width, height);
    if (s.nchannels < 1 || s.nchannels > kMaxChannels)
      throwInputError("images of 1 to {} channels are read, '{}' has {}", kMaxChannels, name_, s.nchannels);
    if (std::cmp_not_equal(s.channelnames.size(), s.nchannels))
      throwInputError("image '{}' can't be decoded: it names {} of its {} channels", name_, s.channelnames.size(),
                      s.nchannels);
  }

  // Integers were multiplied by the float 1/255, which is not always the float nearest to i/255.
  void roundToStoredSteps(std::vector<float>& data) const {
    const OIIO::TypeDesc type = spec().format;
    if (type != OIIO::TypeDesc::UINT8 && type != OIIO::TypeDesc::UINT16) return;
    const float largest = type == OIIO::TypeDesc::UINT8 ? 255.0f : 65535.0f;
    for (float& value : data) value = std::round(value * largest) / largest;
  }

  std::vector<float> placeInDisplayWindow(const std::vector<float>& data, int channels) const {
    const OIIO::ImageSpec& s = spec();
    const auto n = static_cast<std::size_t>(channels);
    std::vector<float> placed(pixelCount(s.full_width, s.full_height) * n, 0.0f);
    const int x0 = std::max(s.x, s.full_x);
    const int x1 = std::min(s.x + s.width, s.full_x + s.full_width);
    for (int y = std::max(s.y, s.full_y); x0 < x1 && y < std::min(s.y + s.height, s.full_y + s.full_height); ++y) {
      const std::size_t from = pixelCount(s.width, y - s.y) + static_cast<std::size_t>(x0 - s.x);
      const std::size_t to = pixelCount(s.full_width, y - s.full_y) + static_cast<std::size_t>(x0 - s.full_x);
      std::copy_n(&data[from * n], static_cast<std::size_t>(x1 - x0) * n, &placed[to * n]);
    }
    return placed;
  }

  std::string name_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

DecodedImage decode(std::span<const std::byte> bytes, const std::string& format, const std::string& name,
                    int maxChannels) {
  ImageReader reader(bytes, format, name);
  const OIIO::ImageSpec& spec = reader.spec();
  const int channels = std::min(spec.nchannels, maxChannels);
  return {.width = spec.full_width,
          .height = spec.full_height,
          .alphaChannel = spec.alpha_channel < channels ? spec.alpha_channel : -1,
          .isFloat = spec.format.is_floating_point(),
          .channelNames = {spec.channelnames.begin(), spec.channelnames.begin() + channels},
          .values = reader.readChannels(channels)};
}

OIIO::TypeDesc typeOf(ChannelType type) {
  constexpr std::array kTypes = {OIIO::TypeDesc::UINT8, OIIO::TypeDesc::UINT16, OIIO::TypeDesc::FLOAT};
  return kTypes[static_cast<std::size_t>(type)];
}

// Encodes in memory, so that a failed write can't leave part of a file and formats need no files of their own.
std::string encode(const EncodeRequest& request) {
  const std::string format = request.format;
  const OIIO::TypeDesc type = typeOf(request.type);
  OIIO::ImageSpec spec(request.width, request.height, static_cast<int>(request.channelNames.size()), type);
  spec.channelnames = request.channelNames;
  // Without it OpenImageIO writes the time of day into EXR files: the same picture would not be the same bytes.
  spec.attribute("DateTime", "");
  if (request.type == ChannelType::float32)
    spec["compression"] = "zip";
  else
    spec["oiio:UnassociatedAlpha"] = 1;
  auto output = OIIO::ImageOutput::create(format);
  if (!output) throwEnvironmentError("OpenImageIO on this machine has no writer for {}", format);
  std::vector<unsigned char> buffer;
  OIIO::Filesystem::IOVecOutput memory(buffer);
  if (!output->set_ioproxy(&memory) || !output->open("memory." + format, spec) ||
      !output->write_image(type, request.values) || !output->close())
    throwEnvironmentError("a {} x {} image can't be encoded as {}: {}", spec.width, spec.height, format,
                          firstLine(output->geterror()));
  return {buffer.begin(), buffer.end()};
}

}  // namespace
}  // namespace pb

extern "C" const pb::ImageCodecs probebenchImageCodecs;
const pb::ImageCodecs probebenchImageCodecs = {pb::kImageCodecsIdentity, pb::decode, pb::encode};
