// Robust fits to control pairs: a start that withstands outliers, and reweighting from there.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "agricolmap/control_points/control_points.hpp"
#include "agricolmap/control_points/control_points_fit.hpp"

namespace agricolmap::control_points {

/// Nobody picks better than to this [m]; keeps exact pairs from making outliers of each other.
inline constexpr double kLeastPickSigma = 1e-3;

/// Pairs that determine the model.
std::size_t minimalPairs(ControlModel model);

/// Deviations of a residual's coordinates.
struct PickSigmas {
  double horizontal = 0.0;  ///< [m]
  double vertical = 0.0;    ///< [m]
  /// Of a residual, in deviations.
  double distance(const Eigen::Vector3d& residual) const;
};

/// The control pairs among some pairs, relative to the first of them (UTM coordinates cost no
/// digits), and fits to them. Poses are local: between those relative coordinates. Keeps `options`
/// by reference.
class ControlFit {
 public:
  ControlFit(std::span<const ControlPair> pairs, const ControlOptions& options);

  std::size_t size() const { return places_.size(); }
  const PairPlaces& places() const { return places_; }
  /// Indices among the given pairs.
  const std::vector<std::size_t>& given() const { return given_; }

  /// Weighted least squares; one weight per control pair.
  std::optional<Eigen::Affine3d> fit(std::span<const double> weights) const {
    return fitPairs(places_, weights, options_.model);
  }
  /// The minimal fit (or that to all pairs) with the smallest middle residual; nothing when none
  /// exists that does not mirror.
  std::optional<Eigen::Affine3d> leastMedian() const;
  /// Deviations from the residuals of a fit; what the fit's own parameters took out is put back.
  PickSigmas sigmas(const Eigen::Affine3d& local) const;
  /// Tukey's biweight at fixed deviations until the pose stands still; `weights` become the last
  /// ones. Nothing when the pairs that keep weight determine no pose.
  std::optional<Eigen::Affine3d> reweighted(const Eigen::Affine3d& start, const PickSigmas& sigmas,
                                            std::vector<double>& weights) const;

  /// Transformed moving place − fixed place [m].
  Eigen::Vector3d residual(const Eigen::Affine3d& local, const ControlPair& pair) const;
  Eigen::Affine3d inFileCoordinates(const Eigen::Affine3d& local) const;

 private:
  std::vector<Eigen::Vector3d> residuals(const Eigen::Affine3d& local) const;
  std::optional<Eigen::Affine3d> minimalFit(const std::vector<std::size_t>& chosen) const;
  double quantile(std::vector<double> values) const;

  const ControlOptions& options_;
  std::vector<std::size_t> given_;
  Eigen::Vector3d moving_origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d fixed_origin_ = Eigen::Vector3d::Zero();
  PairPlaces places_;
};

}  // namespace agricolmap::control_points
