#include "agricolmap/6_refine/block_refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/4_associate/correlate/blocks.hpp"
#include "agricolmap/6_refine/block_shifts.hpp"

namespace agricolmap {

void describe(OptionTable& table, BlockRefineOptions& options) {
  table.integer("rounds", options.rounds, 0, 100, "",
                "how often blocks are moved and the strip laid by them; 0: not at all");
  table.number("side", options.side, 0.1, 10.0, "m", "side of a block");
  table.number("robust", options.robust, 0.1, 1e6, "deviations",
               "blocks whose shifts differ more from the affine fade out (Cauchy weight)");
  table.number("drift", options.drift, 1e-4, 10.0, "m",
               "deviation of the shifts that is expected at least, for strips are bent");
  table.number("trust", options.trust, 1e-4, 10.0, "m",
               "expected error of a corner before: what the blocks leave open stays");
}

namespace {

constexpr std::size_t kLeastBlocks = 4;
constexpr int kReweightings = 10;
// Median of the length of a two-dimensional normal deviate, in deviations of a component.
constexpr double kMedianLength = 1.1774;

using Parameters = Eigen::Matrix<double, 6, 1>;
using Square = Eigen::Matrix<double, 6, 6>;

/// Derivative of the displacement at `q` to (shift, linear part by columns).
Eigen::Matrix<double, 2, 6> jacobian(const Eigen::Vector2d& q) {
  Eigen::Matrix<double, 2, 6> j;
  j << Eigen::Matrix2d::Identity(), q.x() * Eigen::Matrix2d::Identity(),
      q.y() * Eigen::Matrix2d::Identity();
  return j;
}

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Displacements around `centre` that fit the blocks' shifts, and vanish where they say nothing.
Parameters fitShifts(const std::vector<BlockShift>& blocks, const Eigen::Vector2d& centre,
                     const Square& corners, const BlockRefineOptions& options) {
  Parameters fit = Parameters::Zero();
  for (int i = 0; i < kReweightings; ++i) {
    std::vector<double> length;
    for (const BlockShift& block : blocks) {
      length.push_back((block.shift - jacobian(block.place - centre) * fit).norm());
    }
    const double deviation = std::max(options.drift, medianOf(length) / kMedianLength);
    const double trust = deviation / options.trust;
    Square normal = trust * trust * corners;
    Parameters right = Parameters::Zero();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const double u = length[b] / (options.robust * deviation);
      const double weight = 1.0 / (1.0 + u * u);
      const auto j = jacobian(blocks[b].place - centre);
      normal += weight * j.transpose() * j;
      right += weight * j.transpose() * blocks[b].shift;
    }
    fit = normal.ldlt().solve(right);
  }
  return fit;
}

}  // namespace

std::optional<Eigen::Affine2d> refineByBlocks(const SignalMap& fixed, const SignalMap& moving,
                                              const Eigen::Affine2d& pose,
                                              const BlockRefineOptions& options) {
  checkOptions(options);
  const StripFrame strip = stripFrame(moving);
  Eigen::Affine2d result = pose;
  for (int round = 0; round < options.rounds; ++round) {
    std::vector<BlockShift> blocks = shiftBlocks(fixed, moving, result, options.side);
    std::erase_if(blocks, [](const BlockShift& block) { return !block.usable; });
    if (blocks.size() < kLeastBlocks) return std::nullopt;
    const Eigen::Vector2d centre = result * strip.centre;
    Square corners = Square::Zero();
    for (const Eigen::Vector2d& corner : strip.corners()) {
      const auto j = jacobian(result * corner - centre);
      corners += 0.25 * j.transpose() * j;
    }
    const Parameters fit = fitShifts(blocks, centre, corners, options);
    Eigen::Affine2d moved = Eigen::Affine2d::Identity();
    moved.linear() += Eigen::Map<const Eigen::Matrix2d>(fit.data() + 2);
    moved.translation() = centre + fit.head<2>() - moved.linear() * centre;
    result = moved * result;
  }
  return result;
}

}  // namespace agricolmap
