#include "scenes/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string_view>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/shading/shading.h"

namespace pb {
namespace {

// Files that declare more than this (16384 x 16384) are refused before memory is allocated for them.
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr int kMaxChannels = 64;

struct Magic {
  std::string_view bytes;
  const char* format;  // OpenImageIO's name of the reader
};

// Formats are told apart by content: names lie, and images inside a .glb have none.
constexpr std::array kMagics = {
    Magic{"\x89PNG\r\n\x1a\n", "png"},
    Magic{"\xff\xd8\xff", "jpeg"},
    Magic{"\x76\x2f\x31\x01", "openexr"},
    Magic{"#?", "hdr"},
    Magic{"PF", "pnm"},
    Magic{"Pf", "pnm"},
    Magic{"P6", "pnm"},
    Magic{"P5", "pnm"},
    Magic{std::string_view("II*\0", 4), "tiff"},
    Magic{std::string_view("MM\0*", 4), "tiff"},
    Magic{"BM", "bmp"},
    Magic{"RIFF", "webp"},
};

// OpenImageIO's messages may have several lines; ours have one.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string_view asText(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t bigEndian32(std::string_view text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<unsigned char>(text[at + i]);
  return value;
}

// Walks the chunks up to IEND. libpng would report a missing end to standard error, or not at all where only the end
// is cut off.
bool pngIsComplete(std::string_view text) {
  constexpr std::size_t kChunkOverhead = 12;  // length, type and checksum
  std::size_t at = 8;
  while (at + kChunkOverhead <= text.size()) {
    if (text.substr(at + 4, 4) == "IEND") return true;
    at += kChunkOverhead + bigEndian32(text, at);
  }
  return false;
}

std::string formatOf(std::span<const std::byte> bytes, const std::string& name) {
  const std::string_view text = asText(bytes);
  const auto* magic = std::ranges::find_if(kMagics, [&](const Magic& m) { return text.starts_with(m.bytes); });
  if (magic == kMagics.end())
    throwInputError("an image is wanted (EXR, HDR, PFM, PNG, JPEG, TIFF, BMP, PNM, WebP), '{}' is none of these", name);
  if (magic->format == std::string_view("png") && !pngIsComplete(text))
    throwInputError("image '{}' is truncated", name);
  return magic->format;
}

// An opened image in memory, already checked for sane dimensions.
class ImageReader {
 public:
  ImageReader(std::span<const std::byte> bytes, const std::string& name)
      : name_(name), memory_(const_cast<std::byte*>(bytes.data()), bytes.size()) {
    const std::string format = formatOf(bytes, name);
    input_ = OIIO::ImageInput::create(format);
    if (!input_) throwEnvironmentError("OpenImageIO on this machine has no reader for {} ('{}')", format, name);
    OIIO::ImageSpec configuration;
    configuration["oiio:UnassociatedAlpha"] = 1;
    OIIO::ImageSpec spec;
    if (!input_->set_ioproxy(&memory_) || !input_->open("memory." + format, spec, configuration)) fail();
    checkSpec();
  }

  const OIIO::ImageSpec& spec() const { return input_->spec(); }

  // The first channels of the display window, interleaved; 0 where the file's data window leaves it uncovered.
  std::vector<float> readChannels(int channels) {
    const OIIO::ImageSpec& s = spec();
    std::vector<float> data(pixelCount(s.width, s.height) * static_cast<std::size_t>(channels));
    if (!input_->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, data.data()) || input_->has_error()) fail();
    roundToStoredSteps(data);
    const bool whole = s.x == s.full_x && s.y == s.full_y && s.width == s.full_width && s.height == s.full_height;
    return whole ? data : placeInDisplayWindow(data, channels);
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

glm::vec4 rgbaOf(std::span<const float> channels, int alphaChannel) {
  const std::size_t colors = channels.size() - (alphaChannel >= 0 ? 1 : 0);
  glm::vec4 pixel(0.0f, 0.0f, 0.0f, alphaChannel >= 0 ? channels[static_cast<std::size_t>(alphaChannel)] : 1.0f);
  if (colors == 1) return {channels[0], channels[0], channels[0], pixel.w};
  for (std::size_t i = 0; i < std::min<std::size_t>(colors, 3); ++i) pixel[static_cast<int>(i)] = channels[i];
  return pixel;
}

// Encodes in memory, so that a failed write can't leave part of a file and formats need no files of their own.
std::string encode(const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
  auto output = OIIO::ImageOutput::create(format);
  if (!output) throwEnvironmentError("OpenImageIO on this machine has no writer for {}", format);
  std::vector<unsigned char> buffer;
  OIIO::Filesystem::IOVecOutput memory(buffer);
  if (!output->set_ioproxy(&memory) || !output->open(std::string("memory.") + format, spec) ||
      !output->write_image(type, pixels) || !output->close())
    throwEnvironmentError("a {} x {} image can't be encoded as {}: {}", spec.width, spec.height, format,
                          firstLine(output->geterror()));
  return {buffer.begin(), buffer.end()};
}

OIIO::ImageSpec exrSpec(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  spec["compression"] = "zip";
  return spec;
}

// NaN becomes 0.
template <class Integer>
Integer quantised(float value) {
  constexpr float kLargest = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(value > 0.0f ? std::min(value, 1.0f) * kLargest + 0.5f : 0.0f);
}

template <class Integer>
std::string encodePngAs(const ImageRgba& encoded, int channels, OIIO::TypeDesc type) {
  std::vector<Integer> values;
  values.reserve(encoded.size() * static_cast<std::size_t>(channels));
  for (const glm::vec4& pixel : encoded)
    for (int c = 0; c < channels; ++c) values.push_back(quantised<Integer>(pixel[c]));
  OIIO::ImageSpec spec(encoded.width(), encoded.height(), channels, type);
  spec["oiio:UnassociatedAlpha"] = 1;
  return encode("png", spec, type, values.data());
}

ImageRgba withOpaqueAlpha(const Image& image) {
  ImageRgba rgba(image.width(), image.height());
  std::ranges::transform(image, rgba.begin(), [](glm::vec3 p) { return glm::vec4(p, 1.0f); });
  return rgba;
}

std::string lowerCaseExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

LoadedImage readImage(const std::string& path) {
  const std::string bytes = readFile(path);
  return readImage(std::as_bytes(std::span(bytes)), path);
}

LoadedImage readImage(std::span<const std::byte> bytes, const std::string& name) {
  ImageReader reader(bytes, name);
  const OIIO::ImageSpec& spec = reader.spec();
  const int channels = std::min(spec.nchannels, 4);
  const int alphaChannel = spec.alpha_channel < channels ? spec.alpha_channel : -1;
  const std::vector<float> data = reader.readChannels(channels);
  LoadedImage image{ImageRgba(spec.full_width, spec.full_height),
                    spec.format.is_floating_point() ? Encoding::linear : Encoding::srgb};
  const auto n = static_cast<std::size_t>(channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = rgbaOf(std::span(data).subspan(i * n, n), alphaChannel);
  return image;
}

Image rgbOf(const ImageRgba& pixels) {
  Image rgb(pixels.width(), pixels.height());
  std::ranges::transform(pixels, rgb.begin(), [](glm::vec4 p) { return glm::vec3(p); });
  return rgb;
}

float linearFromSrgb(float encoded) { return shading::srgbDecode(encoded); }
float srgbFromLinear(float linear) { return shading::srgbEncode(linear); }

std::vector<NamedPlane> readExrChannels(const std::string& path) {
  const std::string bytes = readFile(path);
  ImageReader reader(std::as_bytes(std::span(bytes)), path);
  const OIIO::ImageSpec& spec = reader.spec();
  const std::vector<float> data = reader.readChannels(spec.nchannels);
  std::vector<NamedPlane> planes;
  const auto n = static_cast<std::size_t>(spec.nchannels);
  for (std::size_t c = 0; c < n; ++c) {
    planes.push_back({spec.channelnames[c], Plane(spec.full_width, spec.full_height)});
    for (std::size_t i = 0; i < planes[c].plane.size(); ++i) planes[c].plane[i] = data[i * n + c];
  }
  return planes;
}

std::string encodeExr(const Image& image) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  return encode("openexr", exrSpec(image.width(), image.height(), 3), OIIO::TypeDesc::FLOAT, image.data());
}

std::string encodePng(const ImageRgba& encoded, int bitsPerChannel) {
  const bool opaque = std::ranges::all_of(encoded, [](glm::vec4 p) { return p.w >= 1.0f; });
  return bitsPerChannel == 8 ? encodePngAs<std::uint8_t>(encoded, opaque ? 3 : 4, OIIO::TypeDesc::UINT8)
                             : encodePngAs<std::uint16_t>(encoded, opaque ? 3 : 4, OIIO::TypeDesc::UINT16);
}

void writeExr(const std::string& path, const Image& image) { writeFileAtomically(path, encodeExr(image)); }

void writeExr(const std::string& path, const std::vector<NamedPlane>& channels) {
  if (channels.empty()) throwInputError("an EXR file wants at least one channel, '{}' would have none", path);
  const Plane& first = channels.front().plane;
  OIIO::ImageSpec spec = exrSpec(first.width(), first.height(), static_cast<int>(channels.size()));
  spec.channelnames.clear();
  std::vector<float> data(first.size() * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    spec.channelnames.push_back(channels[c].name);
    assert(channels[c].plane.size() == first.size());
    for (std::size_t i = 0; i < first.size(); ++i) data[i * channels.size() + c] = channels[c].plane[i];
  }
  writeFileAtomically(path, encode("openexr", spec, OIIO::TypeDesc::FLOAT, data.data()));
}

void writePngEncoded(const std::string& path, const Image& encoded) {
  writeFileAtomically(path, encodePng(withOpaqueAlpha(encoded), 8));
}

void writePng(const std::string& path, const Image& linear) {
  Image encoded = linear;
  for (glm::vec3& p : encoded) p = {srgbFromLinear(p.x), srgbFromLinear(p.y), srgbFromLinear(p.z)};
  writePngEncoded(path, encoded);
}

void writeImage(const std::string& path, const Image& linear) {
  const std::string extension = lowerCaseExtension(path);
  if (extension == ".exr") return writeExr(path, linear);
  if (extension == ".png") return writePng(path, linear);
  throwInputError("images are written as .exr or .png, got '{}'", path);
}

}  // namespace pb
