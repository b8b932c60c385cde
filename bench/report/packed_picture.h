// Pictures as the report's page carries them: half floats, predicted, deflated. The page's decoder is page/pictures.js.
//
// A packed picture is a zlib stream of 2 * 3 * width * height bytes: the low bytes of all residuals, then their high
// bytes; channel after channel, row after row. A residual is the 16 bits of a half float minus those of its prediction,
// modulo 2^16: the same place in the base picture or, without one, the pixel to the left (0 at the left border).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/image.h"

namespace pb {

// The bits of the half floats nearest to the values, channel after channel: R of all pixels, then G and B. Radiance:
// negative values and NaN become 0, what is beyond the largest half (65504) becomes that.
std::vector<std::uint16_t> halfPlanes(const Image& image);

// `base` is as long as `planes`, or empty.
std::string packPicture(const std::vector<std::uint16_t>& planes, int width, const std::vector<std::uint16_t>& base);

// A zlib stream.
std::string deflate(std::string_view bytes);

std::string base64(std::string_view bytes);

}  // namespace pb
