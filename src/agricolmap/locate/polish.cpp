#include "agricolmap/locate/polish.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "agricolmap/core/bilinear.hpp"

namespace agricolmap::locate {
namespace {

constexpr double kFirstStep = 1.4;  // cells
constexpr double kLastStep = 0.15;  // cells
constexpr int kSweeps = 6;          // per step length, at most

}  // namespace

Polisher::Polisher(const map::SignalMap& moving, const correlation::MatchedFilter& filter,
                   const SearchSpace& space, const Eigen::Matrix3d& strip_metric, double min_inside)
    : filter_(filter), space_(space), min_inside_(min_inside) {
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      const std::size_t i = moving.weight.index(r, c);
      if (moving.weight[i] <= 0.0F) continue;
      const float w = moving.weight[i];
      Cell cell{(moving.frame.centre(r, c) - space.centre).cast<float>(), {}, 0.0F};
      for (const int k : filter.channels()) {
        const float value =
            w * static_cast<float>(filter.options().weight(k)) * moving.channel[k][i];
        cell.value[k] = value;
        cell.energy += value * value;
      }
      energy_ += static_cast<double>(cell.energy);
      cells_.push_back(cell);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(strip_metric);
  directions_ = eigen.eigenvectors() *
                eigen.eigenvalues().cwiseMax(1e-9).cwiseSqrt().cwiseInverse().asDiagonal();
}

double Polisher::score(const Candidate& candidate) const {
  const GridFrame& frame = filter_.frame();
  const Eigen::Matrix2f linear =
      (linearOf(candidate.hypothesis, space_) / frame.cell).cast<float>();
  const Eigen::Vector2f origin = frame.cellOf(space_.centre + candidate.shift).cast<float>();
  const int rows = filter_.fft().rows(), cols = filter_.fft().cols();
  const auto stride = static_cast<std::size_t>(cols);
  double sum = 0.0;
  double inside = 0.0;
  for (const Cell& c : cells_) {
    const float x = origin.x() + linear(0, 0) * c.offset.x() + linear(0, 1) * c.offset.y();
    const float y = origin.y() + linear(1, 0) * c.offset.x() + linear(1, 1) * c.offset.y();
    const auto cells = cellsWithin<float>(rows, cols, x, y);
    if (!cells) continue;
    const std::size_t i = static_cast<std::size_t>(cells->row) * stride + cells->col;
    const auto [a, b, d, e] = cells->shares();
    float score = 0.0F;
    for (const int k : filter_.channels()) {
      const Raster<float>& map = filter_.whitened(k);
      score += c.value[k] *
               (a * map[i] + b * map[i + 1] + d * map[i + stride] + e * map[i + stride + 1]);
    }
    sum += static_cast<double>(score);
    inside += static_cast<double>(c.energy);
  }
  const double share = energy_ > 0.0 ? inside / energy_ : 0.0;
  if (share < min_inside_) return -std::numeric_limits<double>::infinity();
  return sum / (candidate.deviation * std::sqrt(share));
}

Candidate Polisher::improve(Candidate best) const {
  const double cell = filter_.frame().cell;
  best.score = score(best);
  const auto moved = [&](int direction, double length) {
    Candidate next = best;
    if (direction < 3) {
      const Eigen::Vector3d p =
          best.hypothesis.vector() + length * cell * directions_.col(direction);
      next.hypothesis = Hypothesis::fromVector(p);
    } else {
      next.shift[direction - 3] += length * cell;
    }
    next.score = score(next);
    return next;
  };
  for (double step = kFirstStep; step >= kLastStep; step *= 0.5) {
    bool improved = true;
    for (int sweep = 0; sweep < kSweeps && improved; ++sweep) {
      improved = false;
      for (int direction = 0; direction < 5; ++direction) {
        for (const double sign : {1.0, -1.0}) {
          const Candidate next = moved(direction, sign * step);
          if (next.score > best.score) {
            best = next;
            improved = true;
            break;
          }
        }
      }
    }
  }
  return best;
}

}  // namespace agricolmap::locate
