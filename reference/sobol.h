// The Sobol sequence in its first dimensions, and Owen scrambling by hashes.
#pragma once

#include <array>
#include <cstdint>

namespace pb {

// Dimensions of one sequence.
inline constexpr int kSobolDimensions = 4;

constexpr std::uint32_t reverseBits(std::uint32_t v) {
  v = (v & 0x55555555u) << 1 | (v >> 1 & 0x55555555u);
  v = (v & 0x33333333u) << 2 | (v >> 2 & 0x33333333u);
  v = (v & 0x0f0f0f0fu) << 4 | (v >> 4 & 0x0f0f0f0fu);
  v = (v & 0x00ff00ffu) << 8 | (v >> 8 & 0x00ff00ffu);
  return v << 16 | v >> 16;
}

namespace detail {

// A primitive polynomial over GF(2), x^degree + a_1 x^(degree-1) + ... + 1, by the bits a_1 a_2 .. of `coefficients`,
// and the first `degree` odd numbers m_1 < 2, m_2 < 4, ...
struct SobolDimension {
  unsigned degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, 3> m;
};

// Dimensions 2 to 4 of Joe and Kuo, "Constructing Sobol Sequences with Better Two-Dimensional Projections", SIAM J.
// Sci. Comput. 30, 2008: the authors' table new-joe-kuo-6.21201.
inline constexpr std::array<SobolDimension, kSobolDimensions - 1> kJoeKuo = {
    {{1, 0, {1}}, {2, 1, {1, 3}}, {3, 1, {1, 3, 1}}}};

using SobolColumns = std::array<std::uint32_t, 32>;

// Column k: what bit k of the index adds to the coordinate, the coordinate's first binary digit in bit 0.
constexpr SobolColumns sobolColumns(const SobolDimension& dimension) {
  const unsigned s = dimension.degree;
  SobolColumns v{};  // v_k = m_k / 2^k as fractions of 2^32
  for (unsigned k = 0; k < 32; ++k) {
    if (k < s) {
      v[k] = dimension.m[k] << (31 - k);
      continue;
    }
    v[k] = v[k - s] ^ v[k - s] >> s;
    for (unsigned i = 1; i < s; ++i)
      if ((dimension.coefficients >> (s - 1 - i) & 1u) != 0) v[k] ^= v[k - i];
  }
  for (std::uint32_t& column : v) column = reverseBits(column);
  return v;
}

constexpr std::array<SobolColumns, kSobolDimensions> allSobolColumns() {
  std::array<SobolColumns, kSobolDimensions> columns{};
  for (unsigned k = 0; k < 32; ++k) columns[0][k] = 1u << k;  // van der Corput's sequence
  for (std::size_t d = 1; d < columns.size(); ++d) columns[d] = sobolColumns(kJoeKuo[d - 1]);
  return columns;
}

inline constexpr std::array<SobolColumns, kSobolDimensions> kSobolColumns = allSobolColumns();

}  // namespace detail

namespace detail {

// What each value of each half byte of the index adds: eight look-ups in place of up to 32.
using SobolNibbles = std::array<std::array<std::uint32_t, 16>, 8>;

constexpr SobolNibbles sobolNibbles(const SobolColumns& columns) {
  SobolNibbles nibbles{};
  for (std::size_t place = 0; place < nibbles.size(); ++place)
    for (std::size_t value = 0; value < 16; ++value)
      for (std::size_t bit = 0; bit < 4; ++bit)
        if ((value >> bit & 1u) != 0) nibbles[place][value] ^= columns[4 * place + bit];
  return nibbles;
}

// Of the dimensions after the first, whose columns are the identity.
inline constexpr std::array<SobolNibbles, kSobolDimensions - 1> kSobolNibbles = {
    sobolNibbles(kSobolColumns[1]), sobolNibbles(kSobolColumns[2]), sobolNibbles(kSobolColumns[3])};

}  // namespace detail

// Coordinate `dimension` of point `index`, its first binary digit in bit 0.
constexpr std::uint32_t reversedSobol(std::uint32_t index, int dimension) {
  if (dimension == 0) return index;
  const detail::SobolNibbles& nibbles = detail::kSobolNibbles[static_cast<std::size_t>(dimension - 1)];
  std::uint32_t x = 0;
  for (std::size_t place = 0; place < nibbles.size(); ++place) x ^= nibbles[place][index >> (4 * place) & 15u];
  return x;
}

// A permutation of the numbers below 2^32 in which each bit of the result is flipped or not by a hash of the bits below
// it and of the seed: Owen's nested uniform scrambling ("Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995) of
// numbers whose first digit is bit 0. Laine and Karras, "Stratified Sampling for Stochastic Transparency" (2011), with
// the constants of Vegdahl, "Building a Better LK Hash" (2021), which pass more tests of uniformity.
constexpr std::uint32_t scrambleReversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= seed >> 16 | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

}  // namespace pb
