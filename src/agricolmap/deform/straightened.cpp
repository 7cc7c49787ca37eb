#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <string>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/deform/deform.hpp"

namespace agricolmap::deform {
namespace {

constexpr double kOverlapWorthAWord = 0.1;  // [m]

}  // namespace

std::string describe(const Bend& bend) {
  std::string text;
  for (const Slip& slip : bend.deformation.slips) {
    text += fmt::format("{}a slip of {:.2f} m at {:.1f} of {:.1f} m", text.empty() ? "" : ", ",
                        slip.offset.norm(), slip.along, bend.deformation.path().length());
    const double overlap = overlapAt(bend.deformation, slip);
    if (overlap > kOverlapWorthAWord) {
      text += fmt::format(
          " (the parts before and behind it lie over each other there for {:.2f} m, and whose a "
          "point is cannot be told)",
          overlap);
    }
  }
  if (!text.empty()) text += " and ";
  return text + fmt::format(
                    "a bend of the strip, together up to {:.1f} cm off the best single "
                    "transformation, {} followed: blocks that were left out of the fit confirm it",
                    100.0 * bend.most, text.empty() ? "is" : "are");
}

Eigen::Vector3d unbent(const Eigen::Vector3d& moving, const Deformation& deformation,
                       const Eigen::Affine2d& pose) {
  const Eigen::Vector3d displacement = deformation.at(moving.head<2>());
  Eigen::Vector3d straight = moving;
  straight.head<2>() += pose.linear().inverse() * displacement.head<2>();
  straight.z() += displacement.z();
  return straight;
}

Eigen::Affine2d moveOfLongestStretch(const map::SignalMap& moving, const Bend& bend) {
  const Deformation& deformation = bend.deformation;
  if (deformation.slips.empty()) return Eigen::Affine2d::Identity();
  double from = 0.0, longest_from = 0.0, longest_to = 0.0;
  const auto endAt = [&](double to) {
    if (to - from > longest_to - longest_from) longest_from = from, longest_to = to;
    from = to;
  };
  for (const Slip& slip : deformation.slips) endAt(slip.along);
  endAt(deformation.path().length());
  // About the stretch's middle, for the numbers' sake.
  const Eigen::Vector2d middle = deformation.path().point(0.5 * (longest_from + longest_to));
  Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d p = moving.frame.centre(r, c);
      const double along = deformation.path().place(p).along;
      if (along < longest_from || along > longest_to) continue;
      const Eigen::Vector3d row = (p - middle).homogeneous();
      normal += row * row.transpose();
      right += row * deformation.at(p).head<2>().transpose();
    }
  }
  const Eigen::Matrix<double, 3, 2> found = normal.ldlt().solve(right);
  const Eigen::Matrix2d back = bend.pose.linear().inverse();
  const Eigen::Matrix2d slope = back * found.topRows<2>().transpose();
  Eigen::Affine2d move = Eigen::Affine2d::Identity();
  move.linear() += slope;
  move.translation() = back * found.row(2).transpose() - slope * middle;
  return move;
}

map::GridMap straightened(const map::GridMap& moving, const Bend& bend) {
  const Deformation& deformation = bend.deformation;
  map::GridMap straight = moving;
  // What is displaced may come to lie outside the map's frame: a rim as wide as that.
  const int rim = static_cast<int>(std::ceil(1.5 * bend.most / moving.frame.cell)) + 2;
  straight.frame.corner -= Eigen::Vector2d::Constant(rim * moving.frame.cell);
  straight.frame.rows += 2 * rim;
  straight.frame.cols += 2 * rim;
  const int rows = straight.frame.rows, cols = straight.frame.cols;
  straight.weight = Raster<float>(rows, cols);
  straight.height = Raster<float>(rows, cols);
  straight.exg = Raster<float>(rows, cols);
  straight.colour = Raster<Rgb>(rows, cols);
  const Eigen::Matrix2d back = bend.pose.linear().inverse();
  parallelFor(static_cast<std::size_t>(rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < cols; ++c) {
      const Eigen::Vector2d place = straight.frame.centre(r, c);
      // The displacement is known where the point was: twice is enough of what changes so slowly.
      Eigen::Vector2d from = place - back * deformation.at(place).head<2>();
      const Eigen::Vector3d displacement = deformation.at(from);
      from = place - back * displacement.head<2>();
      const Eigen::Vector2d cell = moving.frame.cellOf(from);
      const int fr = static_cast<int>(std::lround(cell.y()));
      const int fc = static_cast<int>(std::lround(cell.x()));
      if (!moving.weight.contains(fr, fc) || !moving.valid(fr, fc)) continue;
      const std::size_t i = straight.weight.index(r, c);
      const std::size_t j = moving.weight.index(fr, fc);
      straight.weight[i] = moving.weight[j];
      straight.height[i] = moving.height[j] + static_cast<float>(displacement.z());
      straight.exg[i] = moving.exg[j];
      straight.colour[i] = moving.colour[j];
    }
  });
  return straight;
}

}  // namespace agricolmap::deform
