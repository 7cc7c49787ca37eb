#include "agricolmap/fuse/surface_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace agricolmap::fuse {
namespace {

/// A point this far above all others of its cell flies [m].
constexpr float kAlone = 0.05F;
constexpr float kNone = -std::numeric_limits<float>::infinity();

/// The two highest of a cell.
struct Highest {
  float first = kNone;
  float second = kNone;
  std::uint32_t points = 0;

  void take(float z) {
    ++points;
    if (z > first) {
      second = first;
      first = z;
    } else if (z > second) {
      second = z;
    }
  }
  /// Where the surface lies, at most.
  float top() const { return points > 2 && first - second > kAlone ? second : first; }
};

struct Sums {
  float height = 0.0F;
  float exg = 0.0F;
  std::array<float, 3> colour{};
  float points = 0.0F;

  void add(Rgb other) {
    colour[0] += static_cast<float>(other.r);
    colour[1] += static_cast<float>(other.g);
    colour[2] += static_cast<float>(other.b);
  }
  /// A whole cell as if it were one point.
  void add(const map::GridMap& map, int row, int col) {
    points += 1.0F;
    height += map.height(row, col);
    exg += map.exg(row, col);
    add(map.colour(row, col));
  }
};

/// What is summed of a cell beside its height and its Excess Green.
struct ColourSums {
  std::array<float, 3> colour{};
  float points = 0.0F;
};

/// Index of the cell that a point of the frame lies in.
class CellFinder {
 public:
  CellFinder(const GridFrame& frame, const Eigen::Vector3d& shift)
      : frame_(frame), shift_(shift.cast<float>()) {}
  Eigen::Vector3f moved(const Eigen::Vector3f& local) const { return local + shift_; }
  std::optional<std::size_t> operator()(const Eigen::Vector3f& moved) const {
    const double col =
        std::floor((static_cast<double>(moved.x()) - frame_.corner.x()) / frame_.cell);
    const double row =
        std::floor((static_cast<double>(moved.y()) - frame_.corner.y()) / frame_.cell);
    if (!(col >= 0.0 && row >= 0.0 && col < frame_.cols && row < frame_.rows)) return std::nullopt;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame_.cols) +
           static_cast<std::size_t>(col);
  }

 private:
  GridFrame frame_;
  Eigen::Vector3f shift_;
};

map::GridMap emptyMap(const GridFrame& frame) {
  map::GridMap map;
  map.frame = frame;
  map.weight = Raster<float>(frame.rows, frame.cols);
  map.height = Raster<float>(frame.rows, frame.cols);
  map.exg = Raster<float>(frame.rows, frame.cols);
  map.colour = Raster<Rgb>(frame.rows, frame.cols);
  return map;
}

void setCell(map::GridMap& map, std::size_t i, const Sums& sums, float weight) {
  const float share = 1.0F / sums.points;
  map.weight[i] = weight;
  map.height[i] = sums.height * share;
  map.exg[i] = sums.exg * share;
  const auto mean = [&](std::size_t c) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(sums.colour[c] * share, 0.0F, 255.0F)));
  };
  map.colour[i] = {mean(0), mean(1), mean(2)};
  map.points += static_cast<std::size_t>(weight);
  ++map.filled;
}

/// Where the surface of each cell lies, at most; `weight` becomes the number of its points.
Raster<float> topsOf(const PointStream& cloud, const CellFinder& cellOf, Raster<float>& weight) {
  Raster<Highest> highest(weight.rows(), weight.cols());
  cloud.pass([&](const PointBatch& batch) {
    for (const Eigen::Vector3f& local : batch.xyz) {
      const Eigen::Vector3f point = cellOf.moved(local);
      if (const auto cell = cellOf(point)) highest[*cell].take(point.z());
    }
  });
  Raster<float> tops(weight.rows(), weight.cols());
  for (std::size_t i = 0; i < tops.size(); ++i) {
    tops[i] = highest[i].top();
    weight[i] = static_cast<float>(highest[i].points);
  }
  return tops;
}

}  // namespace

double cellFor(double spacing) {
  constexpr double kRoom = 1.1;
  constexpr double kLeast = 0.005, kMost = 1.0;
  constexpr std::array kSteps{1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0};
  const double least = std::max(kLeast, kRoom * spacing) * (1.0 - 1e-9);
  for (double power = 0.001; power < kMost; power *= 10.0) {
    for (const double step : kSteps) {
      if (power * step >= least) return power * step;
    }
  }
  return kMost;
}

map::GridMap surfaceMap(const PointStream& cloud, const Eigen::Vector3d& shift,
                        const GridFrame& frame) {
  const CellFinder cellOf(frame, shift);
  // Sums stand where the means will: of a hectare each further raster is 160 MB.
  map::GridMap map = emptyMap(frame);
  const Raster<float> tops = topsOf(cloud, cellOf, map.weight);
  Raster<ColourSums> sums(frame.rows, frame.cols);
  cloud.pass([&](const PointBatch& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Eigen::Vector3f point = cellOf.moved(batch.xyz[i]);
      const auto cell = cellOf(point);
      if (!cell) continue;
      const float below = tops[*cell] - point.z();
      if (!(below >= 0.0F && below <= static_cast<float>(kSkin))) continue;
      ColourSums& sum = sums[*cell];
      sum.points += 1.0F;
      map.height[*cell] += point.z();
      if (batch.rgb.empty()) continue;
      const Rgb colour = batch.rgb[i];
      map.exg[*cell] += map::excessGreen(colour, map::ExgKind::kChromatic);
      sum.colour[0] += static_cast<float>(colour.r);
      sum.colour[1] += static_cast<float>(colour.g);
      sum.colour[2] += static_cast<float>(colour.b);
    }
  });
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto& [colour, points] = sums[i];
    if (points > 0.0F) setCell(map, i, {map.height[i], map.exg[i], colour, points}, map.weight[i]);
  }
  return map;
}

void fillBetween(map::GridMap& map) {
  constexpr float kLeast = 5.0F;
  std::vector<std::pair<std::size_t, Sums>> empty;
  for (int row = 1; row + 1 < map.frame.rows; ++row) {
    for (int col = 1; col + 1 < map.frame.cols; ++col) {
      if (map.valid(row, col)) continue;
      Sums sums;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
          if (map.valid(r, c)) sums.add(map, r, c);
        }
      }
      if (sums.points >= kLeast) empty.emplace_back(map.weight.index(row, col), sums);
    }
  }
  for (const auto& [i, sums] : empty) setCell(map, i, sums, kBetween);
}

map::GridMap coarsened(const map::GridMap& fine, int factor) {
  GridFrame frame = fine.frame;
  frame.cell *= factor;
  frame.rows = (frame.rows + factor - 1) / factor;
  frame.cols = (frame.cols + factor - 1) / factor;
  map::GridMap coarse = emptyMap(frame);
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 0; col < frame.cols; ++col) {
      Sums sums;
      float weight = 0.0F;
      for (int r = row * factor; r < std::min(fine.frame.rows, (row + 1) * factor); ++r) {
        for (int c = col * factor; c < std::min(fine.frame.cols, (col + 1) * factor); ++c) {
          if (!fine.valid(r, c)) continue;
          weight += fine.weight(r, c);
          sums.add(fine, r, c);
        }
      }
      if (sums.points > 0.0F) setCell(coarse, coarse.weight.index(row, col), sums, weight);
    }
  }
  return coarse;
}

}  // namespace agricolmap::fuse
