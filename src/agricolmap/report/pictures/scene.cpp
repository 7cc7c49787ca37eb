#include "agricolmap/report/pictures/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/convex_hull.hpp"
#include "agricolmap/map/vegetation.hpp"
#include "agricolmap/report/counts.hpp"
#include "agricolmap/report/draw/outline.hpp"

namespace agricolmap::report {
namespace {

constexpr std::size_t kHistogramCells = 50000;
constexpr double kCoarseCell = 0.08;  // for the strip's extent and the insets [m]

bool isConstant(const map::GridMap& map) {
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
PictureValue valueToDraw(const pipeline::Registration& registration) {
  return isConstant(registration.maps.fixed) || isConstant(registration.maps.moving)
             ? PictureValue::kHeight
             : PictureValue::kExg;
}

/// A row of about kHistogramCells cells of the map: a histogram needs no more.
map::GridMap sampled(const map::GridMap& map) {
  const std::size_t step = 1 + map.weight.size() / kHistogramCells;
  map::GridMap sample;
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
    const map::VegetationThreshold found = map::vegetationThreshold(sampled(layer.map()), {});
    if (found.status == map::VegetationStatus::kOk) {
      // The soil's own variation stays dark.
      range = {0.3 * found.soil_mean + 0.7 * found.threshold, found.vegetation_mean};
    }
  }
  if (!(range.high - range.low > 1e-6)) range.high = range.low + 1e-6;
  return range;
}

/// The rectangle that the blocks of the evidence were cut along.
GroundRect blockStrip(const pipeline::Registration& registration) {
  if (!registration.placed) return {};
  const map::StripFrame& strip = registration.placed->evidence.strip;
  return {strip.centre, strip.axes, strip.half_extent};
}

/// Hull of the known cells; without those that hardly have neighbours, such as stray points.
std::vector<Eigen::Vector2d> outlineOf(const LayerLevel& level) {
  constexpr int kNeighbours = 3;
  const auto isKnown = [&](int r, int c) {
    return level.cells.contains(r, c) && level.cells(r, c).known > 0.0F;
  };
  std::vector<Eigen::Vector2d> points;
  for (int r = 0; r < level.frame.rows; ++r) {
    for (int c = 0; c < level.frame.cols; ++c) {
      if (!isKnown(r, c)) continue;
      int neighbours = -1;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) neighbours += isKnown(r + dr, c + dc) ? 1 : 0;
      }
      if (neighbours >= kNeighbours) points.push_back(level.frame.centre(r, c));
    }
  }
  if (points.size() >= 3) return convexHull(std::move(points));
  const Eigen::Vector2d far = level.frame.centre(level.frame.rows - 1, level.frame.cols - 1);
  const Eigen::Vector2d near = level.frame.centre(0, 0);
  return {near, {far.x(), near.y()}, far, {near.x(), far.y()}};
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

std::optional<MapLayer> straightLayer(const pipeline::Registration& result, PictureValue value) {
  if (!result.placed || !result.placed->followed) return std::nullopt;
  return std::optional<MapLayer>(std::in_place, result.placed->followed->straight, value);
}

}  // namespace

Scene::Scene(const pipeline::Registration& result, const PictureInfo& picture_info)
    : registration(result),
      info(picture_info),
      value(valueToDraw(result)),
      fixed(result.maps.fixed, value),
      moving(result.maps.moving, value),
      straight(straightLayer(result, value)),
      fixed_range(rangeOf(fixed, value)),
      moving_range(rangeOf(moving, value)),
      outline(outlineOf(moving.level(kCoarseCell))),
      strip(smallestRectangle(outline)),
      block_strip(blockStrip(result)) {
  const LayerLevel& level = moving.level(kCoarseCell);
  insets = {insetBetween(strip, level, moving_range, -1.0, -0.35),
            insetBetween(strip, level, moving_range, 0.35, 1.0)};
}

std::vector<Eigen::Vector2d> Scene::outlineUnder(const Eigen::Affine2d& pose) const {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector2d& corner : outline) corners.emplace_back(pose * corner);
  return corners;
}

GroundRect Scene::stripUnder(const Eigen::Affine2d& pose) const {
  GroundRect placed;
  placed.axes.col(0) = (pose.linear() * strip.axes.col(0)).normalized();
  placed.axes.col(1) = Eigen::Vector2d(-placed.axes(1, 0), placed.axes(0, 0));
  map::Box2 box;
  for (const Eigen::Vector2d& corner : outlineUnder(pose)) {
    box.extend((placed.axes.transpose() * corner).eval());
  }
  placed.centre = placed.axes * box.center();
  placed.half_extent = (0.5 * box.sizes()).cwiseMax(registration.maps.moving.frame.cell);
  return placed;
}

const std::vector<Match>& Scene::winningMatches() const {
  static const std::vector<Match> none;
  return registration.placed ? winnerOf(registration).matches : none;
}

std::string describeMove(const pipeline::Registration& registration) {
  const HorizontalParts& parts = registration.transform->parts;
  return fmt::format(
      "shift {:.2f} m (x {:+.3f}, y {:+.3f}), heading {:+.2f}°, scales x {:.3f}, y {:.3f}",
      registration.transform->shift.head<2>().norm(), registration.transform->shift.x(),
      registration.transform->shift.y(), degrees(parts.yaw), parts.scale_x, parts.scale_y);
}

}  // namespace agricolmap::report
