#include "bench/metrics/ssim_tile.h"

#include <cmath>
#include <cstddef>

#include "bench/metrics/vector_clones.h"

// Inlined into the clones, so that it is compiled for their instruction sets.
#define PB_INLINE [[gnu::always_inline]] inline

namespace pb::ssim {
namespace {

constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (0.01 L)^2 and (0.03 L)^2 with L = 1
constexpr int kInputRows = kTileRows + 2 * kRadius;

// Rows of a quantity under a tile, and its weighted sums down the columns.
using InputRows = double[kInputRows][kInputWidth];
using ColumnSums = double[kInputWidth];
using RowSums = std::array<double, kTileWidth>;

// Normalised Gaussian weights of the offsets 0 to kRadius.
struct Window {
  double w0, w1, w2, w3, w4, w5;
};
static_assert(kRadius == 5);

Window makeWindow() {
  const auto gaussian = [](int i) { return std::exp(-0.5 * i * i / (kSigma * kSigma)); };
  double sum = gaussian(0);
  for (int i = 1; i <= kRadius; ++i) sum += 2 * gaussian(i);
  return {gaussian(0) / sum, gaussian(1) / sum, gaussian(2) / sum,
          gaussian(3) / sum, gaussian(4) / sum, gaussian(5) / sum};
}

const Window kWindow = makeWindow();

// Weighted sum over the window at `centre`, whose neighbours lie `step` values apart.
template <int step>
PB_INLINE double windowSum(const double* centre, const Window& window) {
  return window.w0 * centre[0] + window.w1 * (centre[-step] + centre[step]) +
         window.w2 * (centre[-2 * step] + centre[2 * step]) + window.w3 * (centre[-3 * step] + centre[3 * step]) +
         window.w4 * (centre[-4 * step] + centre[4 * step]) + window.w5 * (centre[-5 * step] + centre[5 * step]);
}

PB_VECTOR_CLONES void sumColumns(const double* firstRow, int blocks, double* out) {
  const Window window = kWindow;
  const double* const centre = firstRow + kRadius * kInputWidth;
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) out[i] = windowSum<kInputWidth>(centre + i, window);
}

PB_VECTOR_CLONES void squareRow(const float* x, int blocks, double* value, double* square) {
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) {
    const double v = double{x[i]};
    value[i] = v;
    square[i] = v * v;
  }
}

PB_VECTOR_CLONES void multiplyRow(const float* x, const float* y, int blocks, double* product) {
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) product[i] = double{x[i]} * double{y[i]};
}

PB_VECTOR_CLONES void momentsRow(const double* values, const double* squares, int blocks, double* mean,
                                 double* variance) {
  const Window window = kWindow;
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) {
    const double m = windowSum<1>(values + kRadius + i, window);
    mean[i] = m;
    variance[i] = windowSum<1>(squares + kRadius + i, window) - m * m;
  }
}

// What a row of the map needs: sums down the columns of the test's values and squares and of the products.
struct Columns {
  alignas(64) ColumnSums values, squares, products;
};

struct MapSums {
  RowSums ssim{}, contrastStructure{}, weightedSsim{};
};

// SSIM of a row, and both factors' sums by column. One division serves the two quotients.
PB_VECTOR_CLONES void similarityRow(const Columns& columns, const double* meanX, const double* varianceX, int blocks,
                                    double* ssim, double* ssimSums, double* structureSums) {
  const Window window = kWindow;
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) {
    const double mx = meanX[i], my = windowSum<1>(columns.values + kRadius + i, window);
    const double varianceY = windowSum<1>(columns.squares + kRadius + i, window) - my * my;
    const double covariance = windowSum<1>(columns.products + kRadius + i, window) - mx * my;
    const double structure = 2 * covariance + kC2, structureScale = varianceX[i] + varianceY + kC2;
    const double means = 2 * (mx * my) + kC1, meansScale = mx * mx + my * my + kC1;
    const double inverse = 1 / (structureScale * meansScale);
    const double similarity = means * structure * inverse;
    ssim[i] = similarity;
    ssimSums[i] += similarity;
    structureSums[i] += structure * meansScale * inverse;
  }
}

PB_VECTOR_CLONES void addWeighted(const double* values, const float* weights, int blocks, double* sums) {
#pragma GCC ivdep
  for (int i = 0; i < kBlock * blocks; ++i) sums[i] += values[i] * double{weights[i]};
}

// Two rows ahead hide the way to what was last read with the picture before: 4 % of the time.
constexpr int kPrefetchedRows = 2;

template <class T>
void prefetchRow(const T* row, int count) {
  constexpr int kCacheLine = 64 / static_cast<int>(sizeof(T));
  for (int i = 0; i < count; i += kCacheLine) __builtin_prefetch(row + i);
}

int blocksOf(const Tile& tile) { return (tile.width + kBlock - 1) / kBlock; }

double sumFirst(const RowSums& sums, int width) {
  double total = 0;
  for (int i = 0; i < width; ++i) total += sums[static_cast<std::size_t>(i)];
  return total;
}

}  // namespace

void computeReferenceTile(const PaddedPlane& reference, const Tile& tile, ReferenceTile& out) {
  const int blocks = blocksOf(tile), inputBlocks = blocks + 1;
  alignas(64) InputRows values, squares;
  for (int row = 0; row < tile.rows + 2 * kRadius; ++row) {
    squareRow(&reference.values(tile.x, tile.y + row), inputBlocks, values[row], squares[row]);
  }
  for (int row = 0; row < tile.rows; ++row) {
    alignas(64) ColumnSums valueSums, squareSums;
    sumColumns(values[row], inputBlocks, valueSums);
    sumColumns(squares[row], inputBlocks, squareSums);
    const auto index = static_cast<std::size_t>(row);
    momentsRow(valueSums, squareSums, blocks, out.mean[index].data(), out.variance[index].data());
  }
}

TileSums compareTile(const PaddedPlane& reference, const ReferenceTile& referenceTile, const PaddedPlane& test,
                     const PaddedPlane* weights, const Tile& tile) {
  const int blocks = blocksOf(tile), inputBlocks = blocks + 1;
  alignas(64) InputRows values, squares, products;
  for (int row = 0; row < tile.rows + 2 * kRadius; ++row) {
    const float* const y = &test.values(tile.x, tile.y + row);
    if (row + kPrefetchedRows < tile.rows + 2 * kRadius) {
      prefetchRow(&reference.values(tile.x, tile.y + row + kPrefetchedRows), kBlock * inputBlocks);
      prefetchRow(&test.values(tile.x, tile.y + row + kPrefetchedRows), kBlock * inputBlocks);
    }
    squareRow(y, inputBlocks, values[row], squares[row]);
    multiplyRow(&reference.values(tile.x, tile.y + row), y, inputBlocks, products[row]);
  }
  MapSums sums;
  Columns columns;
  alignas(64) RowSums ssim;
  for (int row = 0; row < tile.rows; ++row) {
    if (row + kPrefetchedRows < tile.rows) {
      const auto ahead = static_cast<std::size_t>(row + kPrefetchedRows);
      prefetchRow(referenceTile.mean[ahead].data(), kBlock * blocks);
      prefetchRow(referenceTile.variance[ahead].data(), kBlock * blocks);
    }
    sumColumns(values[row], inputBlocks, columns.values);
    sumColumns(squares[row], inputBlocks, columns.squares);
    sumColumns(products[row], inputBlocks, columns.products);
    const auto index = static_cast<std::size_t>(row);
    similarityRow(columns, referenceTile.mean[index].data(), referenceTile.variance[index].data(), blocks, ssim.data(),
                  sums.ssim.data(), sums.contrastStructure.data());
    if (weights) addWeighted(ssim.data(), &weights->values(tile.x, tile.y + row), blocks, sums.weightedSsim.data());
  }
  return {sumFirst(sums.ssim, tile.width), sumFirst(sums.contrastStructure, tile.width),
          sumFirst(sums.weightedSsim, tile.width)};
}

}  // namespace pb::ssim
