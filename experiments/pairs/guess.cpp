#include "experiments/pairs/guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/hash.hpp"

namespace agricolmap::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

double randomSign(Random& random) { return random.chance(0.5) ? 1.0 : -1.0; }

Eigen::Vector3d middleOf(const Cloud& cloud) { return cloud.origin + meanPoint(cloud); }

}  // namespace

PriorUncertainty AddedError::told() const {
  // Rounded up to a tenth: the error lies within what the method is told.
  const auto up = [](double value) { return std::ceil(10.0 * value - 1e-9) / 10.0; };
  PriorUncertainty told;
  told.translation = std::max(told.translation, up(translation));
  told.heading_deg = std::max(told.heading_deg, up(heading / kDegree));
  told.scale = std::max(told.scale, up(100.0 * scale) / 100.0);
  return told;
}

Eigen::Affine3d scaleError(const AddedError& error, int seed, const Cloud& moving) {
  Random random = Random::stream(static_cast<std::uint64_t>(seed),
                                 hashText(fmt::format("scale {:.4g}", error.scale)));
  const double x = 1.0 + error.scale * randomSign(random);
  const double y = 1.0 + error.scale * randomSign(random);
  const Eigen::Vector3d middle = middleOf(moving);
  return Eigen::Translation3d(middle) * Eigen::Scaling(x, y, 1.0) * Eigen::Translation3d(-middle);
}

Eigen::Affine3d wrongGuess(const std::string& suite, const AddedError& error, int seed,
                           const Cloud& moving, const Eigen::Affine3d& exact) {
  Random random = Random::stream(static_cast<std::uint64_t>(seed),
                                 hashText(fmt::format("{} {:.4g}", suite, error.setting)));
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double heading = error.heading * randomSign(random);
  const Eigen::Vector3d there = exact * middleOf(moving);
  const Eigen::Vector3d shift(error.translation * std::cos(direction),
                              error.translation * std::sin(direction), 0.0);
  return Eigen::Translation3d(there + shift) *
         Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-there) *
         exact;
}

void transformCloud(Cloud& cloud, const Eigen::Affine3d& moved_from_file) {
  // In local coordinates, which keep their digits.
  const Eigen::Affine3d local =
      Eigen::Translation3d(-cloud.origin) * moved_from_file * Eigen::Translation3d(cloud.origin);
  for (Eigen::Vector3f& point : cloud.xyz) point = (local * point.cast<double>()).cast<float>();
}

std::string toldText(const PriorUncertainty& told) {
  const std::string limits = told.anywhere() ? "none"
                                             : fmt::format("{:.6g},{:.6g},{:.6g}", told.translation,
                                                           told.heading_deg, 100.0 * told.scale);
  return limits + (told.scale_unknown ? ",unit" : "");
}

}  // namespace agricolmap::experiments
