// A registration made by hand for tests: a strip across a row field, its truth as the answer.
#pragma once

#include <cmath>

#include "agricolmap/map/test_field.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::testing {

struct TestStrip {
  double field = 12.0;   ///< side of the fixed map [m]
  double length = 6.0;   ///< of the strip [m]
  double width = 1.6;    ///< [m]
  double heading = 0.5;  ///< of the strip's axis [rad]
};

/// Empties the cells outside the turned strip about `centre`.
inline void cutStrip(map::GridMap& map, const TestStrip& strip, const Eigen::Vector2d& centre) {
  const Eigen::Matrix2d to_strip = rotation2(-strip.heading);
  map.filled = 0;
  for (int row = 0; row < map.frame.rows; ++row) {
    for (int col = 0; col < map.frame.cols; ++col) {
      const Eigen::Vector2d local = to_strip * (map.frame.centre(row, col) - centre);
      if (std::abs(local.x()) > 0.5 * strip.length || std::abs(local.y()) > 0.5 * strip.width) {
        map.weight(row, col) = 0.0F;
      }
      if (map.valid(row, col)) ++map.filled;
    }
  }
}

/// True matches with 2 cm of noise and as many wrong ones.
inline void addMatches(pipeline::Registration& result, const TestStrip& strip,
                       const Eigen::Vector2d& centre) {
  Random random(5);
  Placement winner;
  for (double u = -0.475; u < 0.5; u += 0.05) {
    for (double v = -0.45; v < 0.5; v += 0.1) {
      const Eigen::Vector2d moving =
          centre + rotation2(strip.heading) * Eigen::Vector2d(u * strip.length, v * strip.width);
      const Eigen::Vector2d noise(random.normal(0.02), random.normal(0.02));
      const Eigen::Vector2d wrong(random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0));
      winner.matches.push_back({moving, result.placed->pose * moving + noise});
      result.trace.located.matches.push_back(winner.matches.back());
      result.trace.located.matches.push_back({moving, moving + wrong});
    }
  }
  winner.score = static_cast<double>(winner.matches.size());
  Placement loser;
  loser.matches = {{centre, centre}};
  result.trace.located.flow = {
      .seeds = 800,
      .first = {result.trace.located.matches.size(), winner.matches.size()},
      .again = {}};
  result.trace.located.placements = {loser, winner};
  result.placed->placement = 1;
}

/// Blocks along the strip, one in six of which disagrees.
inline void addEvidence(pipeline::Registration& result, const TestStrip& strip,
                        const Eigen::Vector2d& centre) {
  Random random(6);
  const int count = static_cast<int>(strip.length / 1.2);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d along(((i + 0.5) / count - 0.5) * strip.length, 0.0);
    verdict::BlockEvidence block;
    block.place = result.placed->pose * (centre + rotation2(strip.heading) * along);
    block.agrees = i % 6 != 2;
    const double size = block.agrees ? 0.04 : 0.3;
    block.offset = {random.uniform(-size, size), random.uniform(-size, size)};
    if (block.agrees) ++result.placed->evidence.agreeing;
    result.placed->evidence.blocks.push_back(block);
  }
  result.placed->evidence.strip = {
      centre, rotation2(strip.heading), {0.5 * strip.length, 0.5 * strip.width}};
  result.placed->evidence.block_side = 1.2;
  result.placed->evidence.block_size = {1.2, 0.8};
  result.placed->evidence.significance = 21.5;
  result.placed->evidence.uniqueness = 2.4;
}

/// An accepted registration with the true answer.
inline pipeline::Registration testRegistration(const TestStrip& strip = {}) {
  TestField field;
  field.size = strip.field;
  const Truth truth = growField(field);
  const Eigen::Vector2d centre = Eigen::Vector2d::Constant(0.48 * strip.field);
  pipeline::Registration result;
  result.placed.emplace();
  result.transform.emplace();
  result.placed->pose = guessError(centre, {0.9, -0.6}, 0.06, 1.08, 0.94);
  result.maps.fixed = viewOf(
      truth, field, map::Box2(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(strip.field)),
      Eigen::Affine2d::Identity(), 0.02, 1);
  const double c = std::abs(std::cos(strip.heading));
  const double s = std::abs(std::sin(strip.heading));
  const Eigen::Vector2d half(0.5 * (c * strip.length + s * strip.width),
                             0.5 * (s * strip.length + c * strip.width));
  result.maps.moving =
      viewOf(truth, field, map::Box2(centre - half, centre + half), result.placed->pose, 0.1, 2);
  cutStrip(result.maps.moving, strip, centre);
  result.maps.space.centre = centre;
  Eigen::Affine3d lifted = Eigen::Affine3d::Identity();
  lifted.linear().topLeftCorner<2, 2>() = result.placed->pose.linear();
  lifted.translation().head<2>() = result.placed->pose.translation();
  lifted.translation().z() = 0.12;
  result.transform->local_fixed_from_moving = lifted;
  const Eigen::Vector3d origin(432000.1, 5200000.2, 400.3);
  result.transform->fixed_from_moving =
      Eigen::Translation3d(origin) * lifted * Eigen::Translation3d(-origin);
  result.maps.frames.levelled_from_fixed.setIdentity();
  result.maps.frames.levelled_from_moving.setIdentity();
  result.transform->parts = splitHorizontal(result.placed->pose.linear());
  result.transform->shift = {0.9, -0.6, 0.12};
  result.transform->centre = origin + Eigen::Vector3d(centre.x() + 0.9, centre.y() - 0.6, 0.12);
  result.transform->tilt = {0.01, -0.02};
  result.placed->overlap = 0.97;
  result.placed->correlation = 0.68;
  result.placed->heights.status = refine::VerticalStatus::kOk;
  result.placed->heights.residual = 0.013;
  result.placed->heights.cells = 12345;
  addMatches(result, strip, centre);
  addEvidence(result, strip, centre);
  result.verdict = {verdict::Status::kAccepted,
                    {"it scores 2.40 times as high as the next best place",
                     "4 of 5 blocks, placed alone, agree with the whole"},
                    0.98};
  return result;
}

}  // namespace agricolmap::testing
