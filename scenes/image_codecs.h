// Encoded images by way of OpenImageIO: a module of its own (image_codecs.cpp), loaded with the first image.
// OpenImageIO brings some 260 libraries, and linking them took 200 ms of the start of every command.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pb {

inline constexpr char kImageCodecsFile[] = "probebench_images.so";  // as scenes/CMakeLists.txt names it
inline constexpr char kImageCodecsSymbol[] = "probebenchImageCodecs";
// The tool's version and a hash of this header (scenes/CMakeLists.txt): where they are equal, so are the layouts below.
inline constexpr std::uint64_t kImageCodecsIdentity = PROBEBENCH_IMAGE_CODECS_IDENTITY;

// The first channels of the display window, interleaved, top row first; 0 where the file's data window leaves it
// uncovered.
struct DecodedImage {
  int width;
  int height;
  int alphaChannel;  // -1: none
  bool isFloat;
  std::vector<std::string> channelNames;  // as many as there are channels in `values`
  std::vector<float> values;              // as stored: integers scaled to [0,1], not linearised
};

enum class ChannelType : std::uint8_t { uint8, uint16, float32 };

struct EncodeRequest {
  const char* format;  // OpenImageIO's name of the writer
  int width;
  int height;
  std::vector<std::string> channelNames;
  ChannelType type;
  const void* values;  // interleaved, top row first
};

struct ImageCodecs {
  // kImageCodecsIdentity as the module has it. The first member in every version: all else is read if it is ours.
  std::uint64_t identity;
  // `format` is OpenImageIO's name of the reader, `name` is for messages. Throws an input Error.
  DecodedImage (*decode)(std::span<const std::byte> bytes, const std::string& format, const std::string& name,
                         int maxChannels);
  // The file's bytes; throws an environment Error.
  std::string (*encode)(const EncodeRequest& request);
};

}  // namespace pb
