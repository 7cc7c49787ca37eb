#include "agricolmap/map/blocks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::map {
namespace {

/// The values at the 0.5 % and 99.5 % ranks.
std::pair<double, double> innerRange(std::vector<double> values) {
  const auto last = static_cast<double>(values.size() - 1);
  const double low = valueAtRank(values, static_cast<std::size_t>(0.005 * last));
  return {low, valueAtRank(values, static_cast<std::size_t>(0.995 * last))};
}

}  // namespace

StripFrame stripFrame(const SignalMap& map) {
  std::vector<Eigen::Vector2d> seen;
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.weight(r, c) > 0.0F) seen.push_back(map.frame.centre(r, c));
    }
  }
  StripFrame strip;
  if (seen.empty()) return strip;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : seen) mean += p;
  mean /= static_cast<double>(seen.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : seen) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter);
  strip.axes.col(0) = eigen.eigenvectors().col(1);
  strip.axes.col(1) =
      Eigen::Vector2d(-strip.axes(1, 0), strip.axes(0, 0));  // right-handed whatever the solver
  std::vector<double> along, across;
  for (const Eigen::Vector2d& p : seen) {
    const Eigen::Vector2d local = strip.axes.transpose() * (p - mean);
    along.push_back(local.x());
    across.push_back(local.y());
  }
  const auto [u0, u1] = innerRange(std::move(along));
  const auto [v0, v1] = innerRange(std::move(across));
  strip.centre = mean + strip.axes * Eigen::Vector2d(0.5 * (u0 + u1), 0.5 * (v0 + v1));
  strip.half_extent = 0.5 * Eigen::Vector2d(u1 - u0, v1 - v0).array().max(map.frame.cell).matrix();
  return strip;
}

std::vector<Block> cutBlocks(const SignalMap& map, const StripFrame& strip, double side) {
  const auto count = [&](double half) {
    return std::max(1, static_cast<int>(std::lround(2.0 * half / side)));
  };
  const int along = count(strip.half_extent.x());
  const int across = count(strip.half_extent.y());
  const Eigen::Vector2d size =
      2.0 * strip.half_extent.cwiseQuotient(Eigen::Vector2d(along, across));
  std::vector<Block> blocks;
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      Block block;
      block.low = -strip.half_extent + Eigen::Vector2d(i * size.x(), j * size.y());
      block.high = block.low + size;
      block.centre = strip.world(0.5 * (block.low + block.high));
      blocks.push_back(block);
    }
  }
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d from_low =
          (strip.local(map.frame.centre(r, c)) + strip.half_extent).cwiseQuotient(size);
      const int i = static_cast<int>(std::floor(from_low.x()));
      const int j = static_cast<int>(std::floor(from_low.y()));
      if (i < 0 || j < 0 || i >= along || j >= across) continue;
      for (const Raster<float>& channel : map.channel) {
        const auto value = static_cast<double>(channel(r, c));
        blocks[static_cast<std::size_t>(i * across + j)].energy += value * value;
      }
    }
  }
  return blocks;
}

Stretch texturedStretch(const std::vector<Block>& blocks, const StripFrame& strip, double length) {
  // Room for one block at least, whatever the rounding of its ends.
  for (const Block& block : blocks) {
    length = std::max(length, (1.0 + 1e-9) * (block.high.x() - block.low.x()));
  }
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
  if (2.0 * strip.half_extent.x() > length) {
    double most = -1.0;
    for (const Block& first : blocks) {
      double energy = 0.0;
      for (const Block& block : blocks) {
        if (block.low.x() < first.low.x() || block.high.x() > first.low.x() + length) continue;
        energy += block.energy;
      }
      if (energy <= most) continue;
      most = energy;
      from = first.low.x();
      to = first.low.x() + length;
    }
  }
  Stretch stretch;
  double low = strip.half_extent.x(), high = -strip.half_extent.x();
  for (const Block& block : blocks) {
    if (block.low.x() < from || block.high.x() > to) continue;
    stretch.blocks.push_back(block);
    low = std::min(low, block.low.x());
    high = std::max(high, block.high.x());
  }
  stretch.half_extent = {0.5 * (high - low), strip.half_extent.y()};
  return stretch;
}

Eigen::AlignedBox2d boundsOf(const Block& block, const StripFrame& strip) {
  Eigen::AlignedBox2d bounds;
  for (const double u : {block.low.x(), block.high.x()}) {
    for (const double v : {block.low.y(), block.high.y()}) {
      bounds.extend(strip.world({u, v}));
    }
  }
  return bounds;
}

}  // namespace agricolmap::map
