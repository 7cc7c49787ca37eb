// A strip in a row field for tests: both maps and where the one lies in the other.
#pragma once

#include <algorithm>

#include "agricolmap/map/test_field.hpp"

namespace agricolmap::testing {

struct TestScene {
  map::GridMap fixed;   ///< the whole field
  map::GridMap moving;  ///< a strip of `length` × `width` in its middle, laid as `pose` says
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< true, moving → fixed
};

/// How far off the strip lies when it is laid by the guess.
struct TestError {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]
  double yaw = 0.0;                                 ///< [rad]
  double scale_x = 1.0;
  double scale_y = 1.0;
};

/// `length`, `width`: of the strip [m].
inline TestScene testScene(const TestField& field, const TestError& error, double length = 5.0,
                           double width = 1.8) {
  const Truth truth = growField(field);
  TestScene scene;
  scene.middle = Eigen::Vector2d::Constant(0.5 * field.size);
  scene.pose = guessError(scene.middle, error.shift, error.yaw, error.scale_x, error.scale_y);
  const Eigen::Vector2d half(0.5 * length, 0.5 * width);
  scene.fixed = viewOf(truth, field,
                       map::Box2(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(field.size)),
                       Eigen::Affine2d::Identity(), 0.02, 11);
  scene.moving = viewOf(truth, field, map::Box2(scene.middle - half, scene.middle + half),
                        scene.pose, 0.05, 12);
  return scene;
}

/// `pose` moved on by a shift in the fixed frame [m].
inline Eigen::Affine2d shifted(const Eigen::Affine2d& pose, const Eigen::Vector2d& shift) {
  return Eigen::Translation2d(shift) * pose;
}

/// A strip from west to east whose cells truly lie `offset(x)` beside where the pose puts them, x
/// from its western end [m], in bands of `band` cells.
template <typename Offset>
TestScene bentScene(const TestField& field, const TestError& error, double length, int band,
                    const Offset& offset) {
  TestScene scene = testScene(field, error, length);
  const Truth truth = growField(field);
  const GridFrame& frame = scene.moving.frame;
  const map::Box2 window(frame.corner,
                         frame.corner + frame.cell * Eigen::Vector2d(frame.cols, frame.rows));
  for (int first = 0; first < frame.cols; first += band) {
    const Eigen::Vector2d beside = offset((first + 0.5 * band) * frame.cell);
    const map::GridMap view = viewOf(truth, field, window, shifted(scene.pose, beside), 0.05, 12);
    for (int r = 0; r < frame.rows; ++r) {
      for (int c = first; c < std::min(first + band, frame.cols); ++c) {
        scene.moving.weight(r, c) = view.weight(r, c);
        scene.moving.exg(r, c) = view.exg(r, c);
        scene.moving.height(r, c) = view.height(r, c);
        scene.moving.colour(r, c) = view.colour(r, c);
      }
    }
  }
  return scene;
}

}  // namespace agricolmap::testing
