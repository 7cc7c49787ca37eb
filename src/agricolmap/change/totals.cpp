#include "agricolmap/change/totals.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::change {
namespace {

constexpr float kBareCover = 0.1F;

/// What is summed over the cells of one source: all of it moves together.
struct Common {
  double height = 0.0;                              ///< Σ expected height error [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< Σ gradient
  double plane_square = 0.0;                        ///< Σ square of the plane error [m²]
  std::size_t cells = 0;

  /// Square of what the sum of heights may be wrong by [m²].
  double square() const {
    if (cells == 0) return 0.0;
    // Half of a displacement's mean square falls along any direction.
    const double along = 0.5 * plane_square / static_cast<double>(cells);
    return height * height + slope.squaredNorm() * along;
  }
};

/// By central differences; towards what is not known there is no slope.
Eigen::Vector2d gradientAt(const Raster<float>& surface, int row, int col, double cell) {
  const auto along = [&](int dr, int dc) {
    const int low_row = row - dr;
    const int low_col = col - dc;
    const int high_row = row + dr;
    const int high_col = col + dc;
    if (!surface.contains(low_row, low_col) || !surface.contains(high_row, high_col)) return 0.0;
    const auto step = static_cast<double>(surface(high_row, high_col) - surface(low_row, low_col));
    return std::isnan(step) ? 0.0 : step / (2.0 * cell);
  };
  return {along(0, 1), along(1, 0)};
}

/// What one map says of a cell.
struct Look {
  std::uint16_t source = 0;
  double height_error = 0.0;
  double plane_error = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

Look lookAt(const MapHeights& map, int row, int col, double cell) {
  const std::size_t i = map.surface.index(row, col);
  return {map.source[i], static_cast<double>(map.height_error[i]),
          static_cast<double>(map.plane_error[i]), gradientAt(map.surface, row, col, cell)};
}

/// The sources of one map, by their codes.
class Sources {
 public:
  void add(const Look& look) {
    if (look.source >= all_.size()) all_.resize(look.source + std::size_t{1});
    Common& common = all_[look.source];
    common.height += look.height_error;
    common.slope += look.slope;
    common.plane_square += look.plane_error * look.plane_error;
    ++common.cells;
  }
  /// They err apart [m²].
  double square() const {
    double sum = 0.0;
    for (const Common& common : all_) sum += common.square();
    return sum;
  }
  Eigen::Vector2d slope() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Common& common : all_) sum += common.slope;
    return sum;
  }

 private:
  std::vector<Common> all_;
};

class Sum {
 public:
  void add(float change, const Look& a, const Look& b) {
    values_.push_back(change);
    sum_ += static_cast<double>(change);
    of_a_.add(a);
    of_b_.add(b);
  }

  Share share(double cell, const FrameError& frames) {
    Share share;
    share.cells = values_.size();
    if (values_.empty()) return share;
    const double area = cell * cell;
    const auto count = static_cast<double>(values_.size());
    share.area = area * count;
    share.volume = area * sum_;
    const double square = of_a_.square() + of_b_.square() + std::pow(count * frames.height, 2.0) +
                          0.5 * std::pow(frames.plane, 2.0) * of_b_.slope().squaredNorm();
    share.deviation = area * std::sqrt(square);
    share.median = static_cast<double>(median(values_));
    return share;
  }

 private:
  std::vector<float> values_;
  double sum_ = 0.0;
  Sources of_a_;
  Sources of_b_;
};

/// Of a set of cells: all, and those that changed by more than their level.
struct Sums {
  Sum compared;
  Sum rise;
  Sum fall;

  void add(float change, bool significant, const Look& a, const Look& b) {
    compared.add(change, a, b);
    if (significant) (change > 0.0F ? rise : fall).add(change, a, b);
  }
};

}  // namespace

Totals totalsOf(const HeightChange& change, const MapHeights& a, const MapHeights& b, double cell,
                const FrameError& frames, const Raster<std::uint8_t>* stable) {
  Sums sums;
  Sum unchanged;
  std::vector<float> levels;
  for (int row = 0; row < change.change.rows(); ++row) {
    throwIfInterrupted();
    for (int col = 0; col < change.change.cols(); ++col) {
      const float value = change.change(row, col);
      if (std::isnan(value)) continue;
      levels.push_back(change.detection(row, col));
      const Look of_a = lookAt(a, row, col, cell);
      const Look of_b = lookAt(b, row, col, cell);
      sums.add(value, change.significant(row, col) > 0.0F, of_a, of_b);
      if (stable != nullptr && (*stable)(row, col) != 0) unchanged.add(value, of_a, of_b);
    }
  }
  Totals totals;
  totals.compared = sums.compared.share(cell, frames);
  totals.rise = sums.rise.share(cell, frames);
  totals.fall = sums.fall.share(cell, frames);
  if (!levels.empty()) totals.median_detection = static_cast<double>(median(levels));
  if (stable != nullptr) totals.stable = unchanged.share(cell, frames);
  return totals;
}

std::vector<ZoneChange> zoneChanges(const HeightChange& change, const MapHeights& a,
                                    const MapHeights& b, double cell, const FrameError& frames,
                                    const Raster<std::int32_t>& zones, std::size_t count) {
  std::vector<Sums> sums(count);
  for (int row = 0; row < change.change.rows(); ++row) {
    throwIfInterrupted();
    for (int col = 0; col < change.change.cols(); ++col) {
      const float value = change.change(row, col);
      if (zones(row, col) < 0 || std::isnan(value)) continue;
      sums[static_cast<std::size_t>(zones(row, col))].add(
          value, change.significant(row, col) > 0.0F, lookAt(a, row, col, cell),
          lookAt(b, row, col, cell));
    }
  }
  std::vector<ZoneChange> zones_found;
  zones_found.reserve(count);
  for (Sums& of : sums) {
    zones_found.push_back({of.compared.share(cell, frames), of.rise.share(cell, frames),
                           of.fall.share(cell, frames)});
  }
  return zones_found;
}

Raster<std::uint8_t> bareGround(const Raster<float>& cover_a, const Raster<float>& cover_b) {
  Raster<std::uint8_t> bare(cover_a.rows(), cover_a.cols());
  // What is not known is not below anything.
  for (std::size_t i = 0; i < bare.size(); ++i) {
    bare[i] = cover_a[i] < kBareCover && cover_b[i] < kBareCover ? 1 : 0;
  }
  return bare;
}

}  // namespace agricolmap::change
