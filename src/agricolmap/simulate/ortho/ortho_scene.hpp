// A real orthomosaic as the simulator draws it: colours coarser than leaves, the texture below them
// that may differ between the visits, heights of ground and canopy.
#pragma once

#include <array>
#include <cstdint>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/simulate/field/render.hpp"
#include "agricolmap/simulate/ortho/ortho.hpp"

namespace agricolmap::simulate {

/// The mosaic taken apart: colours coarser than leaves, the strength of the rest, heights.
class OrthoScene {
 public:
  /// `field` must live as long as the scene. Throws InputError when its rasters do not fit each
  /// other. `seed` is that of made-up heights.
  OrthoScene(const OrthoField& field, const SimulationOptions& options, std::uint64_t seed);

  double width() const { return field_->gsd * field_->colour.cols(); }
  double height() const { return field_->gsd * field_->colour.rows(); }
  /// What heights of the scene are counted from [m].
  double zero() const { return zero_; }

  /// Whether the mosaic has data there. `mirror`: looks at the mosaic mirrored end to end along its
  /// rows, here and below: the same rows, other plants.
  bool valid(const Eigen::Vector2d& point, bool mirror) const {
    const Eigen::Vector2d at = mosaic(point, mirror) / field_->gsd;
    if (at.x() < 0.0 || at.y() < 0.0) return false;
    const int c = static_cast<int>(at.x());
    const int r = static_cast<int>(at.y());
    if (!field_->colour.contains(r, c)) return false;
    return field_->valid.empty() || field_->valid(r, c) != 0;
  }
  /// Draws the scene as a visit finds it. `own` is the share of fine texture that is the visit's
  /// own.
  Canvas draw(const Window& window, const Visit& visit, double own, bool mirror) const;

 private:
  template <typename Body>
  void forRows(const Body& body) {
    parallelFor(
        static_cast<std::size_t>(field_->colour.rows()),
        [&](std::size_t r) { body(static_cast<int>(r)); }, 16);
  }
  void makeUpHeights();
  void splitHeights();
  void drawCell(const Eigen::Vector2d& point, const Visit& visit, float own, bool mirror,
                Cell& cell, float& ground) const;
  std::array<float, 3> fineAt(const Eigen::Vector2f& at) const;
  Eigen::Vector2f swapShift(const Eigen::Vector2d& point, const Visit& visit) const;

  /// Place in the mosaic of a place in the field [m].
  Eigen::Vector2d mosaic(const Eigen::Vector2d& point, bool mirror) const {
    if (!mirror) return point;
    const Eigen::Vector2d middle(0.5 * width(), 0.5 * height());
    const Eigen::Vector2d row(std::cos(field_->row_heading), std::sin(field_->row_heading));
    const Eigen::Vector2d from = point - middle;
    return middle + from - 2.0 * row.dot(from) * row;
  }
  Eigen::Vector2f pixel(const Eigen::Vector2d& place) const {
    return (place / field_->gsd).cast<float>() - Eigen::Vector2f::Constant(0.5F);
  }

  const OrthoField* field_;
  SimulationOptions options_;
  std::uint64_t seed_;
  std::array<Raster<float>, 3> coarse_;
  Raster<float> strength_;  ///< deviation of the texture finer than leaves, counts
  Raster<float> canopy_;    ///< above ground [m]
  Raster<float> ground_;    ///< [m]
  double zero_ = 0.0;
};

}  // namespace agricolmap::simulate
