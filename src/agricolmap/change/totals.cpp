#include "agricolmap/change/totals.hpp"

#include <Eigen/Core>
#include <cmath>
#include <map>
#include <vector>

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

class Sum {
 public:
  Sum(const HeightChange& change, const MapHeights& a, const MapHeights& b, double cell,
      const FrameError& frames)
      : change_(change), a_(a), b_(b), cell_(cell), frames_(frames) {}

  void add(int row, int col) {
    const std::size_t i = change_.change.index(row, col);
    values_.push_back(change_.change[i]);
    sum_ += static_cast<double>(change_.change[i]);
    addTo(of_a_[a_.source[i]], a_, row, col);
    addTo(of_b_[b_.source[i]], b_, row, col);
  }

  Share share() {
    Share share;
    share.cells = values_.size();
    if (values_.empty()) return share;
    const double area = cell_ * cell_;
    const auto count = static_cast<double>(values_.size());
    share.area = area * count;
    share.volume = area * sum_;
    double square = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (const auto* groups : {&of_a_, &of_b_}) {
      for (const auto& [source, common] : *groups) square += common.square();
    }
    for (const auto& [source, common] : of_b_) slope += common.slope;
    square += std::pow(count * frames_.height, 2.0) +
              0.5 * std::pow(frames_.plane, 2.0) * slope.squaredNorm();
    share.deviation = area * std::sqrt(square);
    share.median = static_cast<double>(median(values_));
    return share;
  }

 private:
  void addTo(Common& common, const MapHeights& map, int row, int col) const {
    const std::size_t i = map.surface.index(row, col);
    const auto plane = static_cast<double>(map.plane_error[i]);
    common.height += static_cast<double>(map.height_error[i]);
    common.slope += gradientAt(map.surface, row, col, cell_);
    common.plane_square += plane * plane;
    ++common.cells;
  }

  const HeightChange& change_;
  const MapHeights& a_;
  const MapHeights& b_;
  double cell_;
  FrameError frames_;
  std::vector<float> values_;
  double sum_ = 0.0;
  std::map<std::uint16_t, Common> of_a_;
  std::map<std::uint16_t, Common> of_b_;
};

}  // namespace

Totals totalsOf(const HeightChange& change, const MapHeights& a, const MapHeights& b, double cell,
                const FrameError& frames, const Raster<std::uint8_t>* stable) {
  const Sum none(change, a, b, cell, frames);
  Sum compared = none;
  Sum rise = none;
  Sum fall = none;
  Sum unchanged = none;
  std::vector<float> levels;
  for (int row = 0; row < change.change.rows(); ++row) {
    for (int col = 0; col < change.change.cols(); ++col) {
      const float value = change.change(row, col);
      if (std::isnan(value)) continue;
      levels.push_back(change.detection(row, col));
      compared.add(row, col);
      if (change.significant(row, col) > 0.0F) (value > 0.0F ? rise : fall).add(row, col);
      if (stable != nullptr && (*stable)(row, col) != 0) unchanged.add(row, col);
    }
  }
  Totals totals;
  totals.compared = compared.share();
  totals.rise = rise.share();
  totals.fall = fall.share();
  if (!levels.empty()) totals.median_detection = static_cast<double>(median(levels));
  if (stable != nullptr) totals.stable = unchanged.share();
  return totals;
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
