#include "agricolmap/verdict/block_shifts.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/map/blocks.hpp"

namespace agricolmap::verdict {
namespace {

constexpr int kSteps = 5;          // Gauss-Newton steps per block
constexpr double kMostMove = 2.5;  // cells; a block that goes further has lost its place
constexpr double kRobust = 2.0;    // deviations, as in the dense refinement (Cauchy)
constexpr std::size_t kLeastCells = 40;

struct Cell {
  Eigen::Vector2d place;  ///< where the pose puts it
  float value[map::kSignalChannels];
};

struct Normal {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double residual2[map::kSignalChannels] = {};
  double weight[map::kSignalChannels] = {};
  double cells = 0.0;
};

/// One linearisation of moving − gain·fixed(place + shift) around `shift`.
Normal linearise(const map::SignalMap& fixed, const std::vector<Cell>& cells,
                 const Eigen::Vector2d& shift, const double gain[], const double deviation[]) {
  const double cell = fixed.frame.cell;
  const Eigen::Vector2d dx(0.5 * cell, 0.0);
  const Eigen::Vector2d dy(0.0, 0.5 * cell);
  Normal normal;
  for (const Cell& c : cells) {
    const Eigen::Vector2d p = c.place + shift;
    const map::SignalSample here = map::sampleSignal(fixed, p);
    const map::SignalSample east = map::sampleSignal(fixed, p + dx),
                            west = map::sampleSignal(fixed, p - dx);
    const map::SignalSample north = map::sampleSignal(fixed, p + dy),
                            south = map::sampleSignal(fixed, p - dy);
    if (std::min({here.weight, east.weight, west.weight, north.weight, south.weight}) <= 0.0F) {
      continue;
    }
    normal.cells += 1.0;
    for (int k = 0; k < map::kSignalChannels; ++k) {
      if (gain[k] <= 0.0) continue;
      const Eigen::Vector2d slope =
          gain[k] / cell *
          Eigen::Vector2d(static_cast<double>(east.value[k] - west.value[k]),
                          static_cast<double>(north.value[k] - south.value[k]));
      const double residual =
          static_cast<double>(c.value[k]) - gain[k] * static_cast<double>(here.value[k]);
      const double u = residual / (kRobust * deviation[k]);
      const double w = 1.0 / (1.0 + u * u);
      // A channel counts as far as the maps agree in it.
      const double information = w / (deviation[k] * deviation[k]);
      normal.matrix += information * slope * slope.transpose();
      normal.right += information * residual * slope;
      normal.residual2[k] += w * residual * residual;
      normal.weight[k] += w;
    }
  }
  return normal;
}

/// Gains of the fixed signals that fit the moving ones best under the pose.
void fitGains(const map::SignalMap& fixed, const std::vector<std::vector<Cell>>& blocks,
              double gain[]) {
  double fm[map::kSignalChannels] = {}, ff[map::kSignalChannels] = {};
  for (const auto& cells : blocks) {
    for (const Cell& c : cells) {
      const map::SignalSample look = map::sampleSignal(fixed, c.place);
      if (look.weight <= 0.0F) continue;
      for (int k = 0; k < map::kSignalChannels; ++k) {
        fm[k] += static_cast<double>(look.value[k] * c.value[k]);
        ff[k] += static_cast<double>(look.value[k] * look.value[k]);
      }
    }
  }
  for (int k = 0; k < map::kSignalChannels; ++k) {
    gain[k] = ff[k] > 0.0 ? std::max(0.1, fm[k] / ff[k]) : 0.0;
  }
}

BlockShift shiftOf(const map::SignalMap& fixed, const std::vector<Cell>& cells,
                   const double gain[]) {
  BlockShift block;
  block.cells = cells.size();
  if (cells.size() < kLeastCells) return block;
  for (const Cell& c : cells) block.place += c.place;
  block.place /= static_cast<double>(cells.size());
  double deviation[map::kSignalChannels];
  std::fill(std::begin(deviation), std::end(deviation), 1.0);
  Normal normal;
  for (int step = 0; step < kSteps; ++step) {
    normal = linearise(fixed, cells, block.shift, gain, deviation);
    if (normal.cells < static_cast<double>(kLeastCells)) return block;
    for (int k = 0; k < map::kSignalChannels; ++k) {
      if (normal.weight[k] <= 0.0) continue;
      deviation[k] = std::max(0.05, std::sqrt(normal.residual2[k] / normal.weight[k]));
    }
    Eigen::Matrix2d damped = normal.matrix;
    damped.diagonal().array() += 1e-3 * normal.matrix.trace() + 1e-12;
    block.shift += damped.ldlt().solve(normal.right);
    if (!(block.shift.norm() <= kMostMove * fixed.frame.cell)) return block;
  }
  block.usable = true;
  return block;
}

}  // namespace

std::vector<BlockShift> shiftBlocks(const map::SignalMap& fixed, const map::SignalMap& moving,
                                    const Eigen::Affine2d& pose, double side) {
  const map::StripFrame strip = map::stripFrame(moving);
  const std::vector<map::Block> blocks = map::cutBlocks(moving, strip, side);
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
        Cell cell{pose * p, {}};
        for (int k = 0; k < map::kSignalChannels; ++k) cell.value[k] = moving.channel[k](r, c);
        cells[b].push_back(cell);
      }
    }
  });
  double gain[map::kSignalChannels];
  fitGains(fixed, cells, gain);
  std::vector<BlockShift> shifts(blocks.size());
  parallelFor(blocks.size(), [&](std::size_t b) { shifts[b] = shiftOf(fixed, cells[b], gain); });
  std::erase_if(shifts, [](const BlockShift& s) { return s.cells < kLeastCells; });
  return shifts;
}

}  // namespace agricolmap::verdict
