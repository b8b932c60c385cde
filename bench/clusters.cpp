#include "bench/clusters.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

namespace pb {
namespace {

constexpr double kShareOfError = 0.5;
constexpr double kShareOfPixels = 0.05;
constexpr int kRowsPerRadius = 90;

Grid<double> squaredErrors(const Image& reference, const Image& test) {
  Grid<double> squares(reference.width(), reference.height());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const glm::dvec3 d = glm::dvec3(test[i]) - glm::dvec3(reference[i]);
    squares[i] = d.x * d.x + d.y * d.y + d.z * d.z;
  }
  return squares;
}

// The least squared error that is high.
double thresholdOf(const Grid<double>& squares, double total) {
  std::vector<double> descending(squares.begin(), squares.end());
  std::ranges::sort(descending, std::greater());
  const auto most =
      std::max<std::size_t>(1, static_cast<std::size_t>(kShareOfPixels * static_cast<double>(descending.size())));
  double sum = 0;
  std::size_t count = 0;
  while (count < most && sum < kShareOfError * total) sum += descending[count++];
  return descending[count - 1];
}

// Groups of pixels for which `isHigh` holds, by the squares around them. Labels are given in the order of rows.
class Labels {
 public:
  Labels(const Grid<double>& squares, double threshold, int radius)
      : labels_(squares.width(), squares.height()), near_(squares.width(), squares.height()) {
    for (int y = 0; y < squares.height(); ++y)
      for (int x = 0; x < squares.width(); ++x)
        if (squares(x, y) >= threshold) markSquare(x, y, radius);
    for (int y = 0; y < squares.height(); ++y)
      for (int x = 0; x < squares.width(); ++x)
        if (near_(x, y) != 0 && labels_(x, y) == 0) flood(x, y, ++count_);
  }

  int count() const { return count_; }
  int operator()(int x, int y) const { return labels_(x, y); }  // from 1 on; 0: far from all that is high

 private:
  void markSquare(int x, int y, int radius) {
    for (int v = std::max(0, y - radius); v <= std::min(near_.height() - 1, y + radius); ++v)
      for (int u = std::max(0, x - radius); u <= std::min(near_.width() - 1, x + radius); ++u) near_(u, v) = 1;
  }

  // All that is near and touches it, corners included.
  void flood(int x0, int y0, int label) {
    std::vector<std::pair<int, int>> open{{x0, y0}};
    labels_(x0, y0) = label;
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      for (int v = std::max(0, y - 1); v <= std::min(near_.height() - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(near_.width() - 1, x + 1); ++u)
          if (near_(u, v) != 0 && labels_(u, v) == 0) {
            labels_(u, v) = label;
            open.emplace_back(u, v);
          }
    }
  }

  Grid<int> labels_;
  Grid<unsigned char> near_;
  int count_ = 0;
};

struct Gathered {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // inclusive
  std::int64_t pixels = 0;
  double squares = 0;
  std::map<int, std::int64_t> objects;  // pixels of each

  void add(int x, int y, double square, int object) {
    if (pixels == 0) x0 = x1 = x, y0 = y;
    x0 = std::min(x0, x);
    x1 = std::max(x1, x);
    y1 = y;  // rows come in order
    ++pixels;
    squares += square;
    ++objects[object];
  }

  ErrorCluster cluster(double total, const std::vector<std::string>& names) const {
    const int object = std::ranges::max_element(objects, {}, [](const auto& entry) { return entry.second; })->first;
    return {.x = x0,
            .y = y0,
            .width = x1 - x0 + 1,
            .height = y1 - y0 + 1,
            .pixels = pixels,
            .share = std::min(1.0, squares / total),
            .object = object < 0 ? "environment" : names[static_cast<std::size_t>(object)]};
  }
};

}  // namespace

std::vector<ErrorCluster> findClusters(const Image& reference, const Image& test, const Grid<int>& objects,
                                       const std::vector<std::string>& names) {
  assert(reference.size() == test.size() && objects.size() == test.size());
  const Grid<double> squares = squaredErrors(reference, test);
  double total = 0;
  for (const double square : squares) total += square;
  if (total <= 0) return {};
  const double threshold = thresholdOf(squares, total);
  const Labels labels(squares, threshold, std::max(1, squares.height() / kRowsPerRadius));
  std::vector<Gathered> gathered(static_cast<std::size_t>(labels.count()));
  for (int y = 0; y < squares.height(); ++y)
    for (int x = 0; x < squares.width(); ++x)
      if (squares(x, y) >= threshold)
        gathered[static_cast<std::size_t>(labels(x, y) - 1)].add(x, y, squares(x, y), objects(x, y));
  std::vector<ErrorCluster> clusters;
  for (const Gathered& g : gathered) clusters.push_back(g.cluster(total, names));
  std::ranges::sort(clusters, {}, [](const ErrorCluster& c) { return std::tuple(-c.share, c.y, c.x); });
  clusters.resize(std::min(clusters.size(), kMostClusters));
  return clusters;
}

}  // namespace pb
