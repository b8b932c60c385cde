#pragma once

#include <string>
#include <string_view>

namespace pb {

// XXH3, 128 bits, as 32 hexadecimal digits.
std::string hexHash(std::string_view bytes);

}  // namespace pb
