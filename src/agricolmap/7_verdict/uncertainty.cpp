#include "agricolmap/7_verdict/uncertainty.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap {

void describe(OptionTable& table, UncertaintyOptions& options) {
  table.number("inflation", options.inflation, 0.0, 1000.0, "",
               "factor on the deviations that the blocks' disagreement gives");
  table.number("floor", options.floor, 0.0, 10.0, "m",
               "displacement that is left when no block disagrees, because all err alike");
  table.number("height_inflation", options.height_inflation, 0.0, 1000.0, "",
               "factor on the deviation of the ground's heights");
  table.number("height_floor", options.height_floor, 0.0, 10.0, "m",
               "deviation of the height that is left without any");
}

namespace {

constexpr int kSteps = 5;          // Gauss-Newton steps per block
constexpr double kMostMove = 2.5;  // cells; a block that goes further has lost its place
constexpr double kRobust = 2.0;    // deviations, as in the dense refinement (Cauchy)
constexpr std::size_t kLeastCells = 40;
constexpr std::size_t kLeastBlocks = 4;
constexpr int kParameters = 5;
constexpr double kLeastRadius = 0.5;  // [m]

/// A block's own shift against the pose and how well its texture fixes it.
struct BlockShift {
  bool seen = false;    ///< the moving map has cells enough there
  bool usable = false;  ///< and the fixed map, too, and their textures fit
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

struct Cell {
  Eigen::Vector2d place;  ///< where the pose puts it
  float value[kSignalChannels];
};

struct Normal {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double residual2 = 0.0;
  double weight = 0.0;
};

/// One linearisation of fixed(place + shift) − gain·moving around `shift`.
Normal linearise(const SignalMap& fixed, const std::vector<Cell>& cells,
                 const Eigen::Vector2d& shift, const double gain[], double deviation) {
  const double cell = fixed.frame.cell;
  const Eigen::Vector2d dx(0.5 * cell, 0.0);
  const Eigen::Vector2d dy(0.0, 0.5 * cell);
  Normal normal;
  for (const Cell& c : cells) {
    const Eigen::Vector2d p = c.place + shift;
    const SignalSample here = sampleSignal(fixed, p);
    const SignalSample east = sampleSignal(fixed, p + dx), west = sampleSignal(fixed, p - dx);
    const SignalSample north = sampleSignal(fixed, p + dy), south = sampleSignal(fixed, p - dy);
    if (std::min({here.weight, east.weight, west.weight, north.weight, south.weight}) <= 0.0F) {
      continue;
    }
    for (int k = 0; k < kSignalChannels; ++k) {
      const Eigen::Vector2d slope(static_cast<double>(east.value[k] - west.value[k]) / cell,
                                  static_cast<double>(north.value[k] - south.value[k]) / cell);
      const double residual =
          static_cast<double>(here.value[k]) - gain[k] * static_cast<double>(c.value[k]);
      const double u = residual / (kRobust * deviation);
      const double w = 1.0 / (1.0 + u * u);
      normal.matrix += w * slope * slope.transpose();
      normal.right -= w * residual * slope;
      normal.residual2 += w * residual * residual;
      normal.weight += w;
    }
  }
  return normal;
}

/// Gains of the moving signals that fit the fixed ones best under the pose.
void fitGains(const SignalMap& fixed, const std::vector<std::vector<Cell>>& blocks, double gain[]) {
  double fm[kSignalChannels] = {}, mm[kSignalChannels] = {};
  for (const auto& cells : blocks) {
    for (const Cell& c : cells) {
      const SignalSample look = sampleSignal(fixed, c.place);
      if (look.weight <= 0.0F) continue;
      for (int k = 0; k < kSignalChannels; ++k) {
        fm[k] += static_cast<double>(look.value[k] * c.value[k]);
        mm[k] += static_cast<double>(c.value[k] * c.value[k]);
      }
    }
  }
  for (int k = 0; k < kSignalChannels; ++k) {
    gain[k] = mm[k] > 0.0 ? std::max(0.1, fm[k] / mm[k]) : 0.0;
  }
}

BlockShift shiftOf(const SignalMap& fixed, const std::vector<Cell>& cells, const double gain[]) {
  BlockShift block;
  if (cells.size() < kLeastCells) return block;
  for (const Cell& c : cells) block.place += c.place;
  block.place /= static_cast<double>(cells.size());
  block.seen = true;
  double deviation = 1.0;
  Normal normal;
  for (int step = 0; step < kSteps; ++step) {
    normal = linearise(fixed, cells, block.shift, gain, deviation);
    if (normal.weight < static_cast<double>(kLeastCells)) return block;
    deviation = std::max(0.05, std::sqrt(normal.residual2 / normal.weight));
    Eigen::Matrix2d damped = normal.matrix;
    damped.diagonal().array() += 1e-3 * normal.matrix.trace() + 1e-12;
    block.shift += damped.ldlt().solve(normal.right);
    if (!(block.shift.norm() <= kMostMove * fixed.frame.cell)) return block;
  }
  block.information = normal.matrix / (deviation * deviation);
  block.usable = true;
  return block;
}

std::vector<BlockShift> shiftBlocks(const SignalMap& fixed, const SignalMap& moving,
                                    const Eigen::Affine2d& pose, const Evidence& evidence) {
  const StripFrame strip = stripFrame(moving);
  const std::vector<Block> blocks = cutBlocks(moving, strip, evidence.block_side);
  std::vector<std::vector<Cell>> cells(blocks.size());
  parallelFor(blocks.size(), [&](std::size_t b) {
    const Eigen::AlignedBox2d bounds = boundsOf(blocks[b], strip);
    const Eigen::Vector2d low = moving.frame.cellOf(bounds.min());
    const Eigen::Vector2d high = moving.frame.cellOf(bounds.max());
    for (int r = std::max(0, static_cast<int>(low.y()));
         r < std::min(moving.frame.rows, static_cast<int>(high.y()) + 2); ++r) {
      for (int c = std::max(0, static_cast<int>(low.x()));
           c < std::min(moving.frame.cols, static_cast<int>(high.x()) + 2); ++c) {
        const Eigen::Vector2d p = moving.frame.centre(r, c);
        if (moving.weight(r, c) <= 0.0F || !blocks[b].contains(strip.local(p))) continue;
        cells[b].push_back({pose * p, {moving.channel[0](r, c), moving.channel[1](r, c)}});
      }
    }
  });
  double gain[kSignalChannels];
  fitGains(fixed, cells, gain);
  std::vector<BlockShift> shifts(blocks.size());
  parallelFor(blocks.size(), [&](std::size_t b) { shifts[b] = shiftOf(fixed, cells[b], gain); });
  std::erase_if(shifts, [](const BlockShift& s) { return !s.seen; });
  return shifts;
}

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

namespace {

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
    sum += pose.at(block.place).trace() + pose.local_rms * pose.local_rms * beyond2 / radius2;
  }
  return std::sqrt(sum / static_cast<double>(strip.size()));
}

}  // namespace

std::optional<PoseUncertainty> estimateUncertainty(const SignalMap& fixed, const SignalMap& moving,
                                                   const Eigen::Affine2d& pose,
                                                   const Evidence& evidence,
                                                   const SearchSpace& space, double height_residual,
                                                   const UncertaintyOptions& options) {
  checkOptions(options);
  if (evidence.block_side <= 0.0) return std::nullopt;
  const std::vector<BlockShift> strip = shiftBlocks(fixed, moving, pose, evidence);
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
  for (const BlockShift& block : blocks) {
    residual2 += (block.shift - result.jacobian(block.place) * fit).squaredNorm();
  }
  const double freedom = std::max(1.0, 2.0 * static_cast<double>(blocks.size()) - kParameters);
  const double variance = residual2 / freedom;
  result.local_rms = std::sqrt(2.0 * variance);
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
  result.covariance = scale * solver.solve(Square::Identity());
  result.expected_rms = expectedOver(strip, blocks, result);
  result.height_deviation =
      std::hypot(options.height_floor, options.height_inflation * height_residual);
  return result;
}

}  // namespace agricolmap
