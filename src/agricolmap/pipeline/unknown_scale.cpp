#include "agricolmap/pipeline/unknown_scale.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::pipeline {
namespace {

constexpr double kLargestFactor = 10.0;
/// Each search covers this share of its range of scales; the rest is for axes that differ.
constexpr double kShare = 0.92;
/// Of the moving map's area, what must fit onto the fixed map at the smallest scale searched.
constexpr double kLeastInside = 0.5;
/// Area below which a moving map holds too few plants [m²], at the largest scale searched.
constexpr double kLeastArea = 1.0;

}  // namespace

std::vector<double> scaleFactors(const map::Box2& moving, const map::Box2& fixed,
                                 const PriorUncertainty& uncertainty) {
  const double half = kShare * std::max(0.05, logScaleLimit(uncertainty));
  const double reach = std::log(kLargestFactor);
  const int count = static_cast<int>(std::ceil((reach - half) / (2.0 * half)));
  const double step = count > 0 ? (reach - half) / count : 0.0;
  std::vector<double> logs = {0.0};
  for (int i = 1; i <= count; ++i) logs.insert(logs.end(), {i * step, -i * step});
  for (int i = 0; i < count; ++i) {
    logs.insert(logs.end(), {(i + 0.5) * step, -(i + 0.5) * step});
  }
  std::vector<double> factors;
  const double stretch = std::exp(2.0 * logScaleLimit(uncertainty));  // of an area
  for (const double log : logs) {
    const double factor = std::exp(log);
    const double area = factor * factor * moving.volume();
    if (kLeastInside * area / stretch > fixed.volume() || area * stretch < kLeastArea) continue;
    factors.push_back(factor);
  }
  return factors;
}

Eigen::Affine3d scaledGuess(const Eigen::Vector3d& middle, const Eigen::Affine3d& guess,
                            double factor) {
  return guess * Eigen::Translation3d(middle) * Eigen::UniformScaling<double>(factor) *
         Eigen::Translation3d(-middle);
}

double scaleOf(const ScaleTrial& trial, const Eigen::Matrix2d& scale_axes) {
  const HorizontalParts parts =
      splitHorizontal(scale_axes.transpose() * trial.outcome.placed->pose.linear() * scale_axes);
  return trial.factor * std::sqrt(parts.scale_x * parts.scale_y);
}

ScaleTrial carriedOver(ScaleTrial trial, const PairFrames& frames) {
  // Levelled moving of now → levelled moving of then, in the plane.
  const Eigen::Affine3d then_from_now =
      trial.frames.levelled_from_moving * frames.levelled_from_moving.inverse();
  Eigen::Affine2d plane = Eigen::Affine2d::Identity();
  plane.linear() = then_from_now.linear().topLeftCorner<2, 2>();
  plane.translation() = then_from_now.translation().head<2>();
  const Placed& placed = *trial.outcome.placed;
  trial.outcome.trace.located.placements = {
      {.pose = placed.pose * plane, .score = placed.evidence.significance, .matches = {}}};
  for (refine::RefinedPose& rival : trial.outcome.rivals) rival.pose = rival.pose * plane;
  trial.frames = frames;
  return trial;
}

}  // namespace agricolmap::pipeline
