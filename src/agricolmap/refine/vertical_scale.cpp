#include "agricolmap/refine/vertical_scale.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::refine {
namespace {

/// Cells of a patch, and patches, below which nothing is told.
constexpr int kLeastCells = 8;
constexpr std::size_t kLeastPatches = 24;
/// Stretches along the strip that are left out in turn.
constexpr std::size_t kStretches = 8;
/// Relief beyond this many deviations of what is left does not count (Tukey).
constexpr double kRobust = 4.0;
constexpr int kIterations = 4;
/// Relative; cells and heights are no better than that.
constexpr double kFloor = 0.005;
/// Of what parts the two reliefs (drift, a dome, leaves taken for ground) so much may be like the
/// relief itself, and so look like a scale; by the simulator's development settings.
constexpr double kLikeRelief = 0.5;
/// Deviations from 1 that no chance explains.
constexpr double kClear = 2.5;

/// Mean ground of a piece of the strip.
struct Patch {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double moving = 0.0;
  double fixed = 0.0;
  int cells = 0;
  double along = 0.0;
};

std::vector<Patch> patchesOf(const std::vector<GroundCell>& cells,
                             const std::vector<double>& ground, const std::vector<double>& lift,
                             double size) {
  std::map<std::pair<long, long>, Patch> sums;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (ground[i] < kSurelyGround) continue;
    const GroundCell& cell = cells[i];
    Patch& patch = sums[{std::lround(cell.place.x() / size), std::lround(cell.place.y() / size)}];
    patch.place += cell.place;
    patch.moving += cell.moving_height;
    patch.fixed += cell.moving_height + cell.difference - lift[i];
    ++patch.cells;
  }
  std::vector<Patch> patches;
  for (auto& [key, patch] : sums) {
    if (patch.cells < kLeastCells) continue;
    patch.place /= patch.cells;
    patch.moving /= patch.cells;
    patch.fixed /= patch.cells;
    patches.push_back(patch);
  }
  return patches;
}

/// In order along the longest direction that the patches have.
void sortAlong(std::vector<Patch>& patches) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Patch& patch : patches) mean += patch.place;
  mean /= static_cast<double>(patches.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Patch& patch : patches) {
    spread += (patch.place - mean) * (patch.place - mean).transpose();
  }
  const Eigen::Vector2d direction =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
  for (Patch& patch : patches) patch.along = direction.dot(patch.place - mean);
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.along < b.along; });
}

/// Relief of the two maps beyond a plane each, and how they vary together.
struct Relief {
  double scale = 0.0;        ///< ratio of the deviations, fixed over moving
  double moving = 0.0;       ///< deviation of the moving map's [m]
  double correlation = 0.0;  ///< of the two
  std::vector<double> left;  ///< fixed − scale · moving of every patch [m]
};

Relief reliefOf(const std::vector<Patch>& patches, const std::vector<double>& weights) {
  Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Eigen::Vector3d row = patches[i].place.homogeneous();
    normal += weights[i] * row * row.transpose();
    right += weights[i] * row * Eigen::RowVector2d(patches[i].moving, patches[i].fixed);
  }
  const Eigen::Matrix<double, 3, 2> planes = normal.ldlt().solve(right);
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();
  std::vector<Eigen::Vector2d> beyond;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Eigen::Vector2d heights(patches[i].moving, patches[i].fixed);
    const Eigen::Vector3d row = patches[i].place.homogeneous();
    beyond.push_back(heights - planes.transpose() * row);
    products += weights[i] * beyond.back() * beyond.back().transpose();
  }
  Relief relief;
  if (!(products(0, 0) > 0.0) || !(products(1, 1) > 0.0)) return relief;
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  relief.moving = std::sqrt(products(0, 0) / sum);
  relief.scale = std::sqrt(products(1, 1) / products(0, 0));
  relief.correlation = products(0, 1) / std::sqrt(products(0, 0) * products(1, 1));
  for (const Eigen::Vector2d& one : beyond) relief.left.push_back(one.y() - relief.scale * one.x());
  return relief;
}

/// How much the scale changes with what of the strip is looked at: deviation by leaving out one
/// stretch after the other (jackknife).
double deviationByStretches(const std::vector<Patch>& patches, const std::vector<double>& weights) {
  std::vector<double> scales;
  for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
    std::vector<double> kept = weights;
    for (std::size_t i = stretch * patches.size() / kStretches;
         i < (stretch + 1) * patches.size() / kStretches; ++i) {
      kept[i] = 0.0;
    }
    scales.push_back(reliefOf(patches, kept).scale);
  }
  double mean = 0.0, squares = 0.0;
  for (const double scale : scales) mean += scale / kStretches;
  for (const double scale : scales) squares += (scale - mean) * (scale - mean);
  return std::sqrt(squares * (kStretches - 1) / kStretches);
}

}  // namespace

bool VerticalScale::clear() const {
  return measured() && std::abs(value - 1.0) > kClear * deviation;
}

VerticalScale measureVerticalScale(const std::vector<GroundCell>& cells,
                                   const std::vector<double>& ground,
                                   const std::vector<double>& lift, double patch) {
  VerticalScale scale;
  std::vector<Patch> patches = patchesOf(cells, ground, lift, patch);
  if (patches.size() < kLeastPatches) return scale;
  sortAlong(patches);
  std::vector<double> weights(patches.size(), 1.0);
  Relief relief = reliefOf(patches, weights);
  for (int iteration = 0; iteration < kIterations && !relief.left.empty(); ++iteration) {
    std::vector<double> distances(relief.left);
    for (double& distance : distances) distance = std::abs(distance);
    const double deviation = std::max(1e-4, deviationFrom(distances));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = tukeyWeight(relief.left[i] / (kRobust * deviation));
    }
    relief = reliefOf(patches, weights);
  }
  const double r = relief.correlation;
  scale.relief = relief.moving;
  scale.correlation = r;
  if (!(r > 0.0)) return scale;
  scale.value = relief.scale;
  scale.deviation =
      std::hypot(kFloor, kLikeRelief * scale.value * std::sqrt(std::max(0.0, 1.0 - r * r)),
                 deviationByStretches(patches, weights));
  return scale;
}

}  // namespace agricolmap::refine
