#include "scenes/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string_view>

#include "scenes/error.h"
#include "scenes/files.h"
#include "scenes/image_codecs.h"
#include "scenes/shading/shading.h"
#include "scenes/shared_library.h"

namespace pb {
namespace {

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

// A module that another installation left in LD_LIBRARY_PATH, or an upgrade left behind, would be called wrongly.
const ImageCodecs& loadCodecs() {
  const SharedLibrary module(kImageCodecsFile);
  const auto& found = *module.symbol<const ImageCodecs>(kImageCodecsSymbol);
  if (found.identity != kImageCodecsIdentity)
    throwEnvironmentError("the library '{}' belongs to another version of probebench", module.path());
  return found;
}

// Loaded once, by whichever thread comes first.
const ImageCodecs& codecs() {
  static const ImageCodecs& loaded = loadCodecs();
  return loaded;
}

DecodedImage decode(std::span<const std::byte> bytes, const std::string& name, int maxChannels) {
  const std::string format = formatOf(bytes, name);
  return codecs().decode(bytes, format, name, maxChannels);
}

glm::vec4 rgbaOf(std::span<const float> channels, int alphaChannel) {
  const std::size_t colors = channels.size() - (alphaChannel >= 0 ? 1 : 0);
  glm::vec4 pixel(0.0f, 0.0f, 0.0f, alphaChannel >= 0 ? channels[static_cast<std::size_t>(alphaChannel)] : 1.0f);
  if (colors == 1) return {channels[0], channels[0], channels[0], pixel.w};
  for (std::size_t i = 0; i < std::min<std::size_t>(colors, 3); ++i) pixel[static_cast<int>(i)] = channels[i];
  return pixel;
}

std::string encodeFloats(int width, int height, const std::vector<std::string>& channels, const float* values) {
  return codecs().encode({"openexr", width, height, channels, ChannelType::float32, values});
}

// NaN becomes 0.
template <class Integer>
Integer quantised(float value) {
  constexpr float kLargest = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(value > 0.0f ? std::min(value, 1.0f) * kLargest + 0.5f : 0.0f);
}

template <class Integer>
std::string encodePngAs(const ImageRgba& encoded, int channels, ChannelType type) {
  static const std::vector<std::string> kNames = {"R", "G", "B", "A"};
  std::vector<Integer> values;
  values.reserve(encoded.size() * static_cast<std::size_t>(channels));
  for (const glm::vec4& pixel : encoded)
    for (int c = 0; c < channels; ++c) values.push_back(quantised<Integer>(pixel[c]));
  return codecs().encode(
      {"png", encoded.width(), encoded.height(), {kNames.begin(), kNames.begin() + channels}, type, values.data()});
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
  const DecodedImage decoded = decode(bytes, name, 4);
  LoadedImage image{ImageRgba(decoded.width, decoded.height), decoded.isFloat ? Encoding::linear : Encoding::srgb};
  const std::size_t n = decoded.channelNames.size();
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = rgbaOf(std::span(decoded.values).subspan(i * n, n), decoded.alphaChannel);
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
  const DecodedImage decoded = decode(std::as_bytes(std::span(bytes)), path, std::numeric_limits<int>::max());
  std::vector<NamedPlane> planes;
  const std::size_t n = decoded.channelNames.size();
  for (std::size_t c = 0; c < n; ++c) {
    planes.push_back({decoded.channelNames[c], Plane(decoded.width, decoded.height)});
    for (std::size_t i = 0; i < planes[c].plane.size(); ++i) planes[c].plane[i] = decoded.values[i * n + c];
  }
  return planes;
}

std::string encodeExr(const Image& image) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  return encodeFloats(image.width(), image.height(), {"R", "G", "B"}, &image.data()->x);
}

std::string encodePng(const ImageRgba& encoded, int bitsPerChannel) {
  const bool opaque = std::ranges::all_of(encoded, [](glm::vec4 p) { return p.w >= 1.0f; });
  return bitsPerChannel == 8 ? encodePngAs<std::uint8_t>(encoded, opaque ? 3 : 4, ChannelType::uint8)
                             : encodePngAs<std::uint16_t>(encoded, opaque ? 3 : 4, ChannelType::uint16);
}

void writeExr(const std::string& path, const Image& image) { writeFileAtomically(path, encodeExr(image)); }

void writeExr(const std::string& path, const std::vector<NamedPlane>& channels) {
  if (channels.empty()) throwInputError("an EXR file wants at least one channel, '{}' would have none", path);
  const Plane& first = channels.front().plane;
  std::vector<std::string> names;
  std::vector<float> data(first.size() * channels.size());
  for (std::size_t c = 0; c < channels.size(); ++c) {
    names.push_back(channels[c].name);
    assert(channels[c].plane.size() == first.size());
    for (std::size_t i = 0; i < first.size(); ++i) data[i * channels.size() + c] = channels[c].plane[i];
  }
  writeFileAtomically(path, encodeFloats(first.width(), first.height(), names, data.data()));
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
