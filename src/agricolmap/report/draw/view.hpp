// What piece of the ground a rectangle of a picture shows.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "agricolmap/report/draw/picture_canvas.hpp"

namespace agricolmap::report {

/// A rectangle of a picture and the ground under it, levelled fixed frame.
struct View {
  PixelRect rect;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();    ///< ground in its middle [m]
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();  ///< columns: ground's right and up
  double scale = 1.0;                                  ///< [px/m]

  Eigen::Vector2d pixel(const Eigen::Vector2d& ground) const {
    const Eigen::Vector2d local = scale * (axes.transpose() * (ground - centre));
    return rect.middle() + Eigen::Vector2d(local.x(), -local.y());
  }
  Eigen::Vector2d ground(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d local = (pixel - rect.middle()) / scale;
    return centre + axes * Eigen::Vector2d(local.x(), -local.y());
  }
  /// Pixels of a ground direction [px/m].
  Eigen::Vector2d direction(const Eigen::Vector2d& ground_vector) const {
    const Eigen::Vector2d local = scale * (axes.transpose() * ground_vector);
    return {local.x(), -local.y()};
  }
};

/// A rectangle of ground, turned by `axes`.
struct GroundRect {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();       ///< [m]
  Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();     ///< columns, orthonormal, right-handed
  Eigen::Vector2d half_extent = Eigen::Vector2d::Ones();  ///< along the axes [m]

  double aspect() const { return half_extent.x() / half_extent.y(); }
  GroundRect grown(double margin) const {
    return {centre, axes, half_extent + Eigen::Vector2d::Constant(margin)};
  }
};

/// The view that shows all of `ground` in `rect`, as large as fits.
inline View fitView(const PixelRect& rect, const GroundRect& ground) {
  const double scale = std::min(0.5 * rect.width / ground.half_extent.x(),
                                0.5 * rect.height / ground.half_extent.y());
  return {rect, ground.centre, ground.axes, scale};
}

}  // namespace agricolmap::report
