#include "agricolmap/verdict/uncertainty.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "agricolmap/verdict/block_shifts.hpp"

namespace agricolmap::verdict {

void listOptions(OptionTable& table, UncertaintyOptions& options) {
  table.number("inflation", options.inflation, 0.0, 1000.0, "",
               "factor on the deviations that the blocks' disagreement gives");
  table.number("floor", options.floor, 0.0, 10.0, "m",
               "displacement that is left when no block disagrees, because all err alike");
  table.number("lean", options.lean, 0.0, 10.0, "m/m",
               "the same by the plants' height, for wind leans all of them one way");
  table.number("height_inflation", options.height_inflation, 0.0, 1000.0, "",
               "factor on the deviation of the ground's heights");
  table.number("height_floor", options.height_floor, 0.0, 10.0, "m",
               "deviation of the height that is left without any");
}

namespace {

constexpr std::size_t kLeastBlocks = 4;
constexpr int kParameters = 5;
constexpr double kLeastRadius = 0.5;  // [m]
/// Blocks whose middles are no further apart are neighbours, corner to corner included [sides].
constexpr double kNeighbours = 1.6;
/// Per axis, of what is left when nothing disagrees along a strip [m]; from calibration.
constexpr double kCommon = 0.003;

using Parameters = Eigen::Matrix<double, kParameters, 1>;
using Square = Eigen::Matrix<double, kParameters, kParameters>;

}  // namespace

Eigen::Matrix<double, 2, 5> PoseUncertainty::jacobian(const Eigen::Vector2d& fixed) const {
  const Eigen::Vector2d q = fixed - centre;
  Eigen::Matrix<double, 2, 5> j;
  j.leftCols<2>().setIdentity();
  j.col(2) = Eigen::Vector2d(-q.y(), q.x());
  j.col(3) = axes.col(0) * axes.col(0).dot(q);
  j.col(4) = axes.col(1) * axes.col(1).dot(q);
  return j;
}

Eigen::Matrix<double, 6, 6> PoseUncertainty::covarianceWithHeight(double turn) const {
  // Between the shifts in the plane and the heading stands the height, which hangs on none of them.
  constexpr std::array<int, kParameters> kPlace = {0, 1, 3, 4, 5};
  Eigen::Matrix<double, 6, 6> with_height = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, kParameters, kParameters> back =
      Eigen::Matrix<double, kParameters, kParameters>::Identity();
  back.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-turn).toRotationMatrix();
  with_height(kPlace, kPlace) = back * covariance * back.transpose();
  with_height(2, 2) = height_deviation * height_deviation;
  return with_height;
}

double doubtOfBend(double rms, const PoseUncertainty& bent, const PoseUncertainty& straight) {
  if (!(bent.scatter_rms > 0.0)) return 0.0;
  return rms * std::min(1.0, straight.scatter_rms / bent.scatter_rms);
}

Eigen::Matrix2d placeCovariance(const PoseUncertainty& pose, const Eigen::Matrix2d& of_fit) {
  const double common = 0.5 * pose.systematic_rms * pose.systematic_rms + kCommon * kCommon;
  return of_fit + common * Eigen::Matrix2d::Identity();
}

namespace {

/// Blocks of parts that lie elsewhere are out of a block's own reach: the parts say where they lie,
/// so that they count. Others that found no place tell nothing and stay out.
void moveWithTheirParts(std::vector<BlockShift>& blocks, const Evidence& evidence,
                        const Eigen::Affine2d& pose) {
  if (evidence.parts.displaced.empty()) return;
  const Eigen::Affine2d moving_from_fixed = pose.inverse();
  for (BlockShift& block : blocks) {
    const double along =
        evidence.strip.local(moving_from_fixed * block.place).x() + evidence.strip.half_extent.x();
    for (const DisplacedPart& part : evidence.parts.displaced) {
      if (along < part.begin || along >= part.end) continue;
      block.shift = part.offset;
      block.usable = true;
    }
  }
}

/// Expected RMS error of the blocks of the whole `strip` [m]. What lies beyond the fixed map hangs
/// on the `compared` blocks like a lever, and the drift that bent these goes on there.
double expectedOver(const std::vector<BlockShift>& strip, const std::vector<BlockShift>& compared,
                    const PoseUncertainty& pose) {
  double radius2 = 0.0;
  for (const BlockShift& block : compared) radius2 += (block.place - pose.centre).squaredNorm();
  radius2 = std::max(radius2 / static_cast<double>(compared.size()), kLeastRadius * kLeastRadius);
  double sum = 0.0;
  for (const BlockShift& block : strip) {
    double beyond2 = std::numeric_limits<double>::infinity();
    for (const BlockShift& other : compared) {
      beyond2 = std::min(beyond2, (block.place - other.place).squaredNorm());
    }
    sum += pose.at(block.place).trace() + pose.scatter_rms * pose.scatter_rms * beyond2 / radius2;
  }
  return std::sqrt(sum / static_cast<double>(strip.size()));
}

/// What the blocks' residuals of `pose`'s parameters, one each and of a `variance` per axis, have
/// in common with those of their neighbours [m²]: deformation is smooth, and what plants did or
/// noise moved of one block says nothing of the next. `inverse`: of the fit's normal matrix.
double sharedByNeighbours(const std::vector<BlockShift>& blocks,
                          const std::vector<Eigen::Vector2d>& residuals, double variance,
                          double reach, const PoseUncertainty& pose, const Square& inverse) {
  double sum = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    for (std::size_t j = i + 1; j < blocks.size(); ++j) {
      if ((blocks[i].place - blocks[j].place).norm() > reach) continue;
      // The fit alone makes residuals unlike one another by this.
      const double hat =
          (pose.jacobian(blocks[i].place) * inverse * pose.jacobian(blocks[j].place).transpose())
              .trace();
      sum += residuals[i].dot(residuals[j]) + variance * hat;
      pairs += 1.0;
    }
  }
  const double all = 2.0 * variance;
  if (pairs == 0.0) return all;
  // Of few pairs chance makes it too small as easily as too large: a deviation of it on top.
  return std::min(all, std::max(0.0, sum / pairs) + all / std::sqrt(2.0 * pairs));
}

}  // namespace

std::optional<PoseUncertainty> estimateUncertainty(
    const map::SignalMap& fixed, const map::SignalMap& moving, const Eigen::Affine2d& pose,
    const Evidence& evidence, const SearchSpace& space, double systematic, double height_deviation,
    const UncertaintyOptions& options) {
  if (evidence.block_side <= 0.0) return std::nullopt;
  std::vector<BlockShift> strip = shiftBlocks(fixed, moving, pose, evidence.block_side);
  moveWithTheirParts(strip, evidence, pose);
  std::vector<BlockShift> blocks;
  std::copy_if(strip.begin(), strip.end(), std::back_inserter(blocks),
               [](const BlockShift& block) { return block.usable; });
  if (blocks.size() < kLeastBlocks) return std::nullopt;
  PoseUncertainty result;
  for (const BlockShift& block : blocks) result.centre += block.place;
  result.centre /= static_cast<double>(blocks.size());
  for (int i = 0; i < 2; ++i) {
    result.axes.col(i) = (pose.linear() * space.scale_axes.col(i)).normalized();
  }
  // The affine that the blocks would rather have, and what it leaves of their shifts. Every block
  // counts alike: drift and wind, not the texture's noise, are what they differ by.
  Square normal = Square::Zero();
  Parameters right = Parameters::Zero();
  for (const BlockShift& block : blocks) {
    const auto j = result.jacobian(block.place);
    normal += j.transpose() * j;
    right += j.transpose() * block.shift;
  }
  normal.diagonal().array() += 1e-9;
  const Eigen::LDLT<Square> solver(normal);
  const Parameters fit = solver.solve(right);
  double residual2 = 0.0;
  std::vector<Eigen::Vector2d> residuals;
  for (const BlockShift& block : blocks) {
    residuals.emplace_back(block.shift - result.jacobian(block.place) * fit);
    residual2 += residuals.back().squaredNorm();
  }
  const double freedom = std::max(1.0, 2.0 * static_cast<double>(blocks.size()) - kParameters);
  const double variance = residual2 / freedom;
  result.scatter_rms = std::sqrt(2.0 * variance);
  const Square inverse = solver.solve(Square::Identity());
  const double reach =
      kNeighbours * evidence.block_side * std::sqrt(std::abs(pose.linear().determinant()));
  result.local_rms =
      std::sqrt(sharedByNeighbours(blocks, residuals, variance, reach, result, inverse));
  // `fit` is what the pose still misses of the blocks' own best affine: counted as well.
  double offset2 = 0.0;
  for (const BlockShift& block : blocks) {
    offset2 += (result.jacobian(block.place) * fit).squaredNorm();
  }
  offset2 /= static_cast<double>(2 * blocks.size());
  const auto count = static_cast<double>(blocks.size());
  const double scale =
      options.inflation * options.inflation * (variance + offset2 * count / kParameters) +
      options.floor * options.floor * count;
  result.covariance = scale * inverse;
  // In any direction, as a shift: what it is of heading and scales the blocks' scatter holds.
  result.systematic_rms = systematic;
  result.covariance.diagonal().head<2>().array() += 0.5 * systematic * systematic;
  result.expected_rms = expectedOver(strip, blocks, result);
  result.height_deviation = height_deviation;
  return result;
}

}  // namespace agricolmap::verdict
