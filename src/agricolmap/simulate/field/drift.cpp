#include "agricolmap/simulate/field/drift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/random.hpp"

namespace agricolmap::simulate {

namespace {
constexpr int kNodes = 256;
constexpr int kWaves = 5;
}  // namespace

Drift::Drift(double length, double share, std::uint64_t seed)
    : step_(length / kNodes), nodes_(kNodes + 1, Eigen::Vector3d::Zero()) {
  Random random = Random::stream(seed, 5);
  // Errors of speed (x), heading (y) and pitch (z) along the path: a constant and slow waves.
  std::vector<Eigen::Vector3d> waves;
  for (int k = 0; k < kWaves; ++k) {
    const double amplitude = 1.0 / (k + 1.0);
    waves.emplace_back(random.normal(amplitude), random.normal(amplitude),
                       random.normal(0.4 * amplitude));
  }
  for (int i = 1; i <= kNodes; ++i) {
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
    for (int k = 0; k < kWaves; ++k) {
      rate += waves[static_cast<std::size_t>(k)] *
              std::cos(std::numbers::pi * k * (i - 0.5) / kNodes + 0.7 * k);
    }
    nodes_[static_cast<std::size_t>(i)] = nodes_[static_cast<std::size_t>(i - 1)] + rate;
  }
  const Eigen::Vector3d middle = nodes_[kNodes / 2];
  double largest = 1e-12;
  for (Eigen::Vector3d& node : nodes_) {
    node -= middle;
    largest = std::max(largest, node.norm());
  }
  for (Eigen::Vector3d& node : nodes_) node *= share * length / largest;
}

Eigen::Vector3d Drift::at(double along, double aside) const {
  const double t = std::clamp(along / step_, 0.0, kNodes - 1e-6);
  const auto i = static_cast<std::size_t>(t);
  // Catmull-Rom, so that the bend is smooth.
  const Eigen::Vector3d& b = nodes_[i];
  const Eigen::Vector3d& c = nodes_[i + 1];
  const Eigen::Vector3d a = i > 0 ? nodes_[i - 1] : Eigen::Vector3d(2.0 * b - c);
  const Eigen::Vector3d d = i + 2 < nodes_.size() ? nodes_[i + 2] : Eigen::Vector3d(2.0 * c - b);
  const double u = t - static_cast<double>(i);
  const Eigen::Vector3d place =
      b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)));
  // What lies beside the path turns with it.
  const double turn = (c.y() - b.y()) / step_;
  return place + Eigen::Vector3d(-aside * turn, 0.0, 0.0);
}

}  // namespace agricolmap::simulate
