#include "agricolmap/refine/dense_refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/refine/residual.hpp"

namespace agricolmap::refine {

void listOptions(OptionTable& table, DenseRefineOptions& options) {
  table.integer("iterations", options.iterations, 1, 1000, "", "Gauss-Newton steps per level");
  table.number("robust", options.robust, 0.1, 1e6, "deviations",
               "residuals beyond this fade out (Cauchy weight)");
  table.number("stop", options.stop, 0.0, 1.0, "cells",
               "a level is done when no corner moves by more");
  table.number("prior_weight", options.prior_weight, 0.0, 1.0, "",
               "pull towards the start of the level, as a share of the data's curvature");
  table.number("max_move", options.max_move, 0.1, 1000.0, "cells",
               "a level that moves a corner further has left its basin: diverged");
  table.integer("hops", options.hops, 0, 100, "",
                "rounds of starting again beside the best, while that helps");
  table.number("hop", options.hop, 0.1, 10.0, "cells", "how far beside it");
  table.group("soil", options.soil);
}

namespace {

constexpr double kMinCells = 30.0;
constexpr std::size_t kChunk = 2048;

/// A seen cell of the moving map.
struct Sample {
  float x, y;  ///< relative to the middle of the moving map [m]
  float weight;
  float value[map::kSignalChannels];
};

struct Samples {
  std::vector<Sample> cells;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_extent = Eigen::Vector2d::Zero();
};

Samples collect(const map::SignalMap& moving) {
  Samples samples;
  Eigen::AlignedBox2d box;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) >= kMinSeen) box.extend(moving.frame.centre(r, c));
    }
  }
  if (box.isEmpty()) return samples;
  samples.middle = box.center();
  samples.half_extent = 0.5 * box.sizes();
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      const std::size_t i = moving.weight.index(r, c);
      if (moving.weight[i] < kMinSeen) continue;
      const Eigen::Vector2f p = (moving.frame.centre(r, c) - samples.middle).cast<float>();
      Sample sample{p.x(), p.y(), moving.weight[i], {}};
      for (int k = 0; k < map::kSignalChannels; ++k) sample.value[k] = moving.channel[k][i];
      samples.cells.push_back(sample);
    }
  }
  return samples;
}

/// The affine as six numbers over middle-relative coordinates: x' = a0·x + a1·y + a2, y' = a3…a5.
using Parameters = Eigen::Matrix<double, 6, 1>;

Parameters parametersOf(const Eigen::Affine2d& affine, const Eigen::Vector2d& middle) {
  const Eigen::Vector2d shift = affine * middle;
  Parameters p;
  p << affine(0, 0), affine(0, 1), shift.x(), affine(1, 0), affine(1, 1), shift.y();
  return p;
}

Eigen::Affine2d affineOf(const Parameters& p, const Eigen::Vector2d& middle) {
  Eigen::Affine2d affine = Eigen::Affine2d::Identity();
  affine.linear() << p[0], p[1], p[3], p[4];
  affine.translation() = Eigen::Vector2d(p[2], p[5]) - affine.linear() * middle;
  return affine;
}

/// Reads the fixed map at moved samples.
class FixedReader {
 public:
  FixedReader(const map::SignalMap& map, const Parameters& p)
      : map_(map), inv_cell_(static_cast<float>(1.0 / map.frame.cell)) {
    for (int i = 0; i < 6; ++i) a_[i] = static_cast<float>(p[i] / map.frame.cell);
    // The shift is made relative to the fixed corner in double before it becomes float.
    a_[2] = static_cast<float>((p[2] - map.frame.corner.x()) / map.frame.cell - 0.5);
    a_[5] = static_cast<float>((p[5] - map.frame.corner.y()) / map.frame.cell - 0.5);
  }

  Look at(const Sample& s) const {
    const float col = a_[0] * s.x + a_[1] * s.y + a_[2];
    const float row = a_[3] * s.x + a_[4] * s.y + a_[5];
    return lookAt(map_, inv_cell_, col, row);
  }

 private:
  const map::SignalMap& map_;
  float inv_cell_;
  float a_[6];
};

/// Sums of one pass over the samples. A sample's row of the Jacobian is (gx·q, gy·q) with
/// q = (x, y, 1): the normal matrix has three different blocks, each a sum of g·g·q·qᵀ.
struct Sums {
  double block[3][6] = {};  ///< gx², gx·gy, gy² times x², xy, x, y², y, 1
  Parameters right = Parameters::Zero();
  double cells = 0.0;
  Products products;
  Sums& operator+=(const Sums& other) {
    for (int b = 0; b < 3; ++b) {
      for (int i = 0; i < 6; ++i) block[b][i] += other.block[b][i];
    }
    right += other.right;
    cells += other.cells;
    products += other.products;
    return *this;
  }
  Eigen::Matrix<double, 6, 6> normal() const {
    const auto full = [](const double(&b)[6]) {
      Eigen::Matrix3d m;
      m << b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5];
      return m;
    };
    Eigen::Matrix<double, 6, 6> normal;
    normal << full(block[0]), full(block[1]), full(block[1]), full(block[2]);
    return normal;
  }
};

void addSample(const Sample& s, const Look& look, const Noise& noise, double robust,
               const bool used[], Sums& sums) {
  sums.cells += 1.0;
  double curvature[3] = {};
  double pull[2] = {};
  for (int k = 0; k < map::kSignalChannels; ++k) {
    if (!used[k]) continue;
    const auto f = static_cast<double>(look.value[k]);
    const auto m = static_cast<double>(s.value[k]);
    const double residual = m - noise.gain[k] * f;
    const double u = residual / (robust * noise.deviation[k]);
    const double w = static_cast<double>(s.weight) / (1.0 + u * u);
    sums.products.add(k, w, f, m, residual);
    const double scale = w / (noise.deviation[k] * noise.deviation[k]);
    const double gx = noise.gain[k] * static_cast<double>(look.dx[k]);
    const double gy = noise.gain[k] * static_cast<double>(look.dy[k]);
    curvature[0] += scale * gx * gx;
    curvature[1] += scale * gx * gy;
    curvature[2] += scale * gy * gy;
    pull[0] += scale * residual * gx;
    pull[1] += scale * residual * gy;
  }
  const auto x = static_cast<double>(s.x), y = static_cast<double>(s.y);
  const double products[6] = {x * x, x * y, x, y * y, y, 1.0};
  for (int b = 0; b < 3; ++b) {
    for (int i = 0; i < 6; ++i) sums.block[b][i] += curvature[b] * products[i];
  }
  for (Eigen::Index b = 0; b < 2; ++b) {
    sums.right[3 * b] += pull[b] * x;
    sums.right[3 * b + 1] += pull[b] * y;
    sums.right[3 * b + 2] += pull[b];
  }
}

Sums pass(const Samples& samples, const FixedReader& reader, const Noise& noise, double robust,
          const bool used[]) {
  return parallelSum<Sums>(samples.cells.size(), kChunk, Sums{},
                           [&](std::size_t begin, std::size_t end) {
                             Sums part;
                             for (std::size_t i = begin; i < end; ++i) {
                               const Look look = reader.at(samples.cells[i]);
                               if (!look.seen) continue;
                               addSample(samples.cells[i], look, noise, robust, used, part);
                             }
                             return part;
                           });
}

/// Largest movement of a corner of the moving map between two parameter sets [m].
double cornerMove(const Parameters& a, const Parameters& b, const Eigen::Vector2d& half) {
  const Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  return poseDistance(cornersOf({-half, half}), affineOf(a, middle), affineOf(b, middle));
}

double correlationOf(const Sums& sums, const bool used[]) {
  double fm = 0.0, norm = 0.0;
  for (int k = 0; k < map::kSignalChannels; ++k) {
    if (!used[k]) continue;
    fm += sums.products.fm[k];
    norm += std::sqrt(sums.products.mm[k] * sums.products.ff[k]);
  }
  return norm > 0.0 ? fm / norm : 0.0;
}

}  // namespace

DenseRefineResult refineDense(const map::SignalMap& fixed, const map::SignalMap& moving,
                              const Eigen::Affine2d& start, const DenseRefineOptions& options,
                              ChannelSet channels) {
  DenseRefineResult result;
  const Samples samples = collect(moving);
  if (samples.cells.empty()) return result;
  bool used[map::kSignalChannels];
  for (int k = 0; k < map::kSignalChannels; ++k) {
    used[k] = (channels & channelSet(k)) != 0U && fixed.has(k) && moving.has(k);
  }
  if (std::none_of(std::begin(used), std::end(used), [](bool use) { return use; })) return result;
  const Parameters first = parametersOf(start, samples.middle);
  Parameters current = first;
  Noise noise;
  Sums sums;
  result.status = RefineStatus::kConverged;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    sums = pass(samples, FixedReader(fixed, current), noise, options.robust, used);
    if (sums.cells < kMinCells) {
      result.status = RefineStatus::kNoOverlap;
      return result;
    }
    sums.products.update(noise);
    const Eigen::Matrix<double, 6, 6> normal = sums.normal();
    const Parameters pull = options.prior_weight * normal.diagonal();
    Eigen::Matrix<double, 6, 6> damped = normal;
    damped.diagonal() += pull + Parameters::Constant(1e-9 * (1.0 + normal.trace()));
    const Parameters step = damped.ldlt().solve(sums.right - pull.cwiseProduct(current - first));
    const Parameters next = current + step;
    const double moved = cornerMove(next, current, samples.half_extent);
    current = next;
    if (!current.allFinite() ||
        cornerMove(current, first, samples.half_extent) > options.max_move * moving.frame.cell) {
      result.status = RefineStatus::kDiverged;
      return result;
    }
    if (moved < options.stop * moving.frame.cell) break;
  }
  sums = pass(samples, FixedReader(fixed, current), noise, options.robust, used);
  result.fixed_from_moving = affineOf(current, samples.middle);
  result.overlap = sums.cells / static_cast<double>(samples.cells.size());
  result.correlation = correlationOf(sums, used);
  return result;
}

std::vector<DenseRefineResult> refineEach(const map::SignalMap& fixed, const map::SignalMap& moving,
                                          std::span<const Eigen::Affine2d> starts,
                                          const DenseRefineOptions& options) {
  std::vector<DenseRefineResult> results(starts.size());
  parallelFor(starts.size(),
              [&](std::size_t i) { results[i] = refineDense(fixed, moving, starts[i], options); });
  return results;
}

}  // namespace agricolmap::refine
