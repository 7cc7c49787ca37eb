#include "agricolmap/report/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "agricolmap/4_associate/correlate/blocks.hpp"
#include "agricolmap/6_refine/vegetation.hpp"

namespace agricolmap {
namespace {

constexpr std::size_t kHistogramCells = 50000;
constexpr double kCoarseCell = 0.08;  // for the strip's extent and the insets [m]

bool isConstant(const GridMap& map) {
  bool any = false;
  float first = 0.0F;
  for (std::size_t i = 0; i < map.exg.size(); ++i) {
    if (!map.valid(i)) continue;
    if (!any) first = map.exg[i];
    any = true;
    if (map.exg[i] != first) return false;
  }
  return true;
}

/// Excess Green where both maps have it, else heights.
PictureValue valueToDraw(const Registration& registration) {
  return isConstant(registration.fixed_map) || isConstant(registration.moving_map)
             ? PictureValue::kHeight
             : PictureValue::kExg;
}

/// A row of about kHistogramCells cells of the map: a histogram needs no more.
GridMap sampled(const GridMap& map) {
  const std::size_t step = 1 + map.weight.size() / kHistogramCells;
  GridMap sample;
  sample.frame = {Eigen::Vector2d::Zero(), map.frame.cell, 1,
                  static_cast<int>((map.weight.size() + step - 1) / step)};
  sample.weight = Raster<float>(1, sample.frame.cols);
  sample.exg = sample.weight;
  for (std::size_t i = 0, k = 0; i < map.weight.size(); i += step, ++k) {
    sample.weight[k] = map.weight[i];
    sample.exg[k] = map.exg[i];
    if (map.valid(i)) ++sample.filled;
  }
  return sample;
}

ValueRange rangeOf(const MapLayer& layer, PictureValue value) {
  ValueRange range{layer.quantile(0.4), layer.quantile(0.97)};
  if (value == PictureValue::kExg) {
    const VegetationThreshold found = vegetationThreshold(sampled(layer.map()), {});
    if (found.status == VegetationStatus::kOk) {
      // The soil's own variation stays dark.
      range = {0.3 * found.soil_mean + 0.7 * found.threshold, found.vegetation_mean};
    }
  }
  if (!(range.high - range.low > 1e-6)) range.high = range.low + 1e-6;
  return range;
}

GroundRect extentOf(const MapLayer& layer) {
  const LayerLevel& level = layer.level(kCoarseCell);
  SignalMap cells;
  cells.frame = level.frame;
  cells.weight = Raster<float>(level.frame.rows, level.frame.cols);
  std::transform(level.cells.begin(), level.cells.end(), cells.weight.begin(),
                 [](const LayerCell& cell) { return cell.known; });
  StripFrame strip = stripFrame(cells);
  // An axis has no sign; pictures run from west to east.
  if (strip.axes(0, 0) < 0.0) strip.axes = -strip.axes;
  return {strip.centre, strip.axes, strip.half_extent};
}

/// Deviation of the strength in a square of side kInsetSide, 0 where little of it is seen.
double detailAt(const LayerLevel& level, const ValueRange& range, const Eigen::Vector2d& centre) {
  const Eigen::Vector2d low =
      level.frame.cellOf(centre - Eigen::Vector2d::Constant(0.5 * kInsetSide));
  const int side = static_cast<int>(kInsetSide / level.frame.cell);
  double sum = 0.0;
  double sum2 = 0.0;
  double count = 0.0;
  for (int r = std::max(0, static_cast<int>(low.y()));
       r < std::min(level.frame.rows, static_cast<int>(low.y()) + side); ++r) {
    for (int c = std::max(0, static_cast<int>(low.x()));
         c < std::min(level.frame.cols, static_cast<int>(low.x()) + side); ++c) {
      const LayerCell& cell = level.cells(r, c);
      if (cell.known <= 0.0F) continue;
      const auto strength = static_cast<double>(range.strength(cell.weighted / cell.known));
      sum += strength;
      sum2 += strength * strength;
      count += 1.0;
    }
  }
  if (count < 0.3 * side * side) return 0.0;
  return std::sqrt(std::max(0.0, sum2 / count - (sum / count) * (sum / count)));
}

/// The place between `from` and `to` (shares of the half length) with most detail.
Eigen::Vector2d insetBetween(const GroundRect& strip, const LayerLevel& level,
                             const ValueRange& range, double from, double to) {
  constexpr int kSteps = 9;
  const double reach = std::max(0.0, strip.half_extent.x() - 0.5 * kInsetSide);
  Eigen::Vector2d best = strip.centre + strip.axes.col(0) * reach * 0.5 * (from + to);
  double most = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double share = from + (to - from) * i / (kSteps - 1);
    const Eigen::Vector2d at = strip.centre + strip.axes.col(0) * reach * share;
    const double detail = detailAt(level, range, at);
    if (detail > most) {
      most = detail;
      best = at;
    }
  }
  return best;
}

}  // namespace

Scene::Scene(const Registration& result, const PictureInfo& picture_info)
    : registration(result),
      info(picture_info),
      value(valueToDraw(result)),
      fixed(result.fixed_map, value),
      moving(result.moving_map, value),
      fixed_range(rangeOf(fixed, value)),
      moving_range(rangeOf(moving, value)),
      strip(extentOf(moving)) {
  const LayerLevel& level = moving.level(kCoarseCell);
  insets = {insetBetween(strip, level, moving_range, -1.0, -0.35),
            insetBetween(strip, level, moving_range, 0.35, 1.0)};
}

std::array<Eigen::Vector2d, 4> Scene::outlineUnder(const Eigen::Affine2d& pose) const {
  std::array<Eigen::Vector2d, 4> corners;
  constexpr std::array<std::array<double, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d local(kSigns[i][0] * strip.half_extent.x(),
                                kSigns[i][1] * strip.half_extent.y());
    corners[i] = pose * (strip.centre + strip.axes * local);
  }
  return corners;
}

GroundRect Scene::stripUnder(const Eigen::Affine2d& pose) const {
  GroundRect placed;
  placed.centre = pose * strip.centre;
  placed.axes.col(0) = (pose.linear() * strip.axes.col(0)).normalized();
  placed.axes.col(1) = Eigen::Vector2d(-placed.axes(1, 0), placed.axes(0, 0));
  placed.half_extent.setZero();
  for (const Eigen::Vector2d& corner : outlineUnder(pose)) {
    placed.half_extent = placed.half_extent.cwiseMax(
        (placed.axes.transpose() * (corner - placed.centre)).cwiseAbs());
  }
  return placed;
}

const Placement* Scene::winner() const {
  const Placement* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Placement& placement : registration.association.placements) {
    if (placement.matches.empty()) continue;
    double sum = 0.0;
    for (const Match& match : placement.matches) {
      sum += (registration.pose * match.moving - match.fixed).norm();
    }
    const double mean = sum / static_cast<double>(placement.matches.size());
    if (mean < least) {
      least = mean;
      best = &placement;
    }
  }
  return best;
}

std::string describeMove(const Registration& registration) {
  const HorizontalParts& parts = registration.parts;
  return fmt::format(
      "shift {:.2f} m (x {:+.3f}, y {:+.3f}), heading {:+.2f}°, scales x {:.3f}, y {:.3f}",
      registration.shift.head<2>().norm(), registration.shift.x(), registration.shift.y(),
      parts.yaw * 180.0 / std::numbers::pi, parts.scale_x, parts.scale_y);
}

}  // namespace agricolmap
