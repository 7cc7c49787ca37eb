// An Earth for tests: metres of a plane that is turned against north, as a map's projection is.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/prescribe/lattice.hpp"

namespace agricolmap::prescribe {

/// (500 000 m, 5 300 000 m) lies at 11.5° E, 48° N; the plane's north is `turn` [rad] west of it.
inline Earth testEarth(double turn = 0.0) {
  const Eigen::Vector2d middle(500000.0, 5300000.0);
  const Eigen::Vector2d place(11.5, 48.0);
  const Eigen::Matrix2d north = Eigen::Rotation2Dd(turn).toRotationMatrix();
  const Eigen::Array2d scale = metresPerDegree(place.y()).array();
  return {[=](const std::vector<Eigen::Vector2d>& points) {
            std::vector<Eigen::Vector2d> result;
            for (const Eigen::Vector2d& point : points) {
              result.emplace_back(place + ((north * (point - middle)).array() / scale).matrix());
            }
            return result;
          },
          [=](const std::vector<Eigen::Vector2d>& points) {
            std::vector<Eigen::Vector2d> result;
            for (const Eigen::Vector2d& point : points) {
              const Eigen::Vector2d metres = ((point - place).array() * scale).matrix();
              result.emplace_back(middle + north.transpose() * metres);
            }
            return result;
          }};
}

}  // namespace agricolmap::prescribe
