#include "agricolmap/fuse/point_rule.hpp"

#include <cmath>

namespace agricolmap::fuse {

std::optional<std::size_t> PointRule::cellOf(const Eigen::Vector3f& place) const {
  const GridFrame& frame = map_.layers.frame;
  const Eigen::Array2d at =
      ((place.head<2>().cast<double>() - frame.corner) / frame.cell).array().floor();
  if (!((at >= 0.0).all() && at.x() < frame.cols && at.y() < frame.rows)) return std::nullopt;
  return map_.layers.source.index(static_cast<int>(at.y()), static_cast<int>(at.x()));
}

std::optional<FusedPoint> PointRule::ofFixed(const Eigen::Vector3f& place, Rgb colour) const {
  const auto cell = cellOf(place);
  if (!cell || map_.layers.source[*cell] != kFixedSource) return std::nullopt;
  const float raised = map_.correction[*cell];
  return FusedPoint{place + Eigen::Vector3f(0.0F, 0.0F, raised), colour, raised,
                    map_.layers.plane_error[*cell], map_.layers.height_error[*cell]};
}

std::optional<FusedPoint> PointRule::ofStrip(std::size_t index, const Eigen::Vector3f& place,
                                             Rgb colour) const {
  const FusedStrip& strip = map_.strips[index];
  Eigen::Vector3f moved = place + strip.moved.cast<float>();
  const auto cell = cellOf(moved);
  if (!cell || map_.layers.source[*cell] != strip.code) return std::nullopt;
  if (strip.flat && !std::isnan(map_.layers.surface[*cell])) {
    moved.z() = map_.layers.surface[*cell];
  }
  return FusedPoint{moved, options_.match_colours ? strip.tone(colour) : colour,
                    moved.z() - place.z(), static_cast<float>(strip.errors.plane),
                    static_cast<float>(strip.errors.height)};
}

}  // namespace agricolmap::fuse
