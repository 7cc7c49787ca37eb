#include "runner/experiments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// The scale errors of the panels of the paper's fig. correct_reg_rate.
const std::vector<double> kScales = {0.0, 0.1, 0.2, 0.3};
const std::vector<double> kTranslations = {0.0, 0.05, 0.13, 0.25, 0.5, 1.0,
                                           2.0, 3.0,  4.0,  5.0,  7.0, 10.0};
const std::vector<double> kHeadings = {0.0, 0.1, 0.2, 0.3, 0.4};
// Of the accuracy: small enough for methods that only refine.
constexpr double kSmallTranslation = 0.05;
constexpr double kSmallHeading = 0.01;

std::vector<Curve> translationCurves(bool quick) {
  std::vector<Curve> curves;
  for (const double scale : quick ? std::vector<double>{0.0} : kScales) {
    Curve curve{"translation", scale, true, {}};
    for (const double size : quick ? std::vector<double>{0.05, 5.0} : kTranslations) {
      curve.cells.push_back({"translation", size, size, 0.0, scale});
    }
    curves.push_back(curve);
  }
  return curves;
}

std::vector<Curve> headingCurves(bool quick) {
  std::vector<Curve> curves;
  for (const double scale : quick ? std::vector<double>{0.0} : kScales) {
    Curve curve{"heading", scale, true, {}};
    for (const double size : quick ? std::vector<double>{0.2} : kHeadings) {
      curve.cells.push_back({"heading", size, 0.0, size, scale});
    }
    curves.push_back(curve);
  }
  return curves;
}

/// All errors at once, as shares of the largest that the paper allows for.
std::vector<Curve> jointCurves(bool quick) {
  Curve curve{"joint", 0.0, false, {}};
  for (const double share : quick ? std::vector<double>{1.0} : std::vector<double>{0.5, 1.0}) {
    curve.cells.push_back({"joint", share, 5.0 * share, 0.2 * share, 0.3 * share});
  }
  return {curve};
}

std::vector<Curve> accuracyCurves(bool quick) {
  Curve curve{"accuracy", 0.0, true, {}};
  for (const int percent :
       quick ? std::vector<int>{10} : std::vector<int>{0, 5, 10, 15, 20, 25, 30}) {
    const double scale = 0.01 * percent;
    curve.cells.push_back({"accuracy", scale, kSmallTranslation, kSmallHeading, scale});
  }
  return {curve};
}

/// One guess that is wrong in everything, by about what a geotag is.
std::vector<Curve> inlierCurves() {
  return {{"inliers", 0.0, false, {{"inliers", 1.0, 1.0, 0.05, 0.05}}}};
}

double randomSign(Random& random) { return random.chance(0.5) ? 1.0 : -1.0; }

Eigen::Vector3d middleOf(const Cloud& cloud) { return cloud.origin + meanPoint(cloud); }

}  // namespace

std::uint64_t hashText(const std::string& text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001B3ULL;
  return hash;
}

std::string Cell::priorText() const {
  // Rounded up to a tenth: the error lies within what the method is told.
  const auto upTo = [](double value) { return std::ceil(10.0 * value - 1e-9) / 10.0; };
  return fmt::format("{:.4g},{:.4g},{:.4g}", std::max(5.0, upTo(translation)),
                     std::max(11.5, upTo(heading / kDegree)), std::max(30.0, upTo(100.0 * scale)));
}

std::vector<std::string> experimentNames() {
  return {"translation", "heading", "joint", "accuracy", "inliers"};
}

std::vector<Curve> curvesOf(const std::string& experiment, bool quick) {
  if (experiment == "translation") return translationCurves(quick);
  if (experiment == "heading") return headingCurves(quick);
  if (experiment == "joint") return jointCurves(quick);
  if (experiment == "accuracy") return accuracyCurves(quick);
  if (experiment == "inliers") return inlierCurves();
  throw UsageError(fmt::format("unknown experiment '{}'; there are: {}", experiment,
                               fmt::join(experimentNames(), ", ")));
}

bool takesPart(const std::string& method, const std::string& experiment) {
  if (experiment != "inliers") return true;
  return method.starts_with("agricolmap") || method == "surf" || method == "orb" ||
         method == "fast-brief" || method == "sift-affine";
}

Eigen::Affine3d scaleError(const Cell& cell, int seed, const Cloud& moving) {
  Random random = Random::stream(static_cast<std::uint64_t>(seed),
                                 hashText(fmt::format("scale {:.4g}", cell.scale)));
  const double x = 1.0 + cell.scale * randomSign(random);
  const double y = 1.0 + cell.scale * randomSign(random);
  const Eigen::Vector3d middle = middleOf(moving);
  return Eigen::Translation3d(middle) * Eigen::Scaling(x, y, 1.0) * Eigen::Translation3d(-middle);
}

Eigen::Affine3d wrongGuess(const Cell& cell, int seed, const Cloud& moving,
                           const Eigen::Affine3d& exact) {
  Random random = Random::stream(static_cast<std::uint64_t>(seed),
                                 hashText(fmt::format("{} {:.4g}", cell.experiment, cell.setting)));
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double heading = cell.heading * randomSign(random);
  const Eigen::Vector3d there = exact * middleOf(moving);
  const Eigen::Vector3d shift(cell.translation * std::cos(direction),
                              cell.translation * std::sin(direction), 0.0);
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

}  // namespace agricolmap::experiments
