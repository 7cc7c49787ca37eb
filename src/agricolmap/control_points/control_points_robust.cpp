#include "agricolmap/control_points/control_points_robust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::control_points {
namespace {

/// Minimal fits that are tried; all of them where there are no more (up to 27 pairs by threes).
constexpr std::size_t kStarts = 3000;
constexpr int kReweights = 100;
constexpr double kStill = 1e-9;  ///< a change of the residuals that ends the reweighting [m]

/// Number of ways to choose k of n, or `most` when there are more.
std::size_t choices(std::size_t n, std::size_t k, std::size_t most) {
  std::size_t result = 1;
  for (std::size_t i = 0; i < k; ++i) {
    result = result * (n - i) / (i + 1);
    if (result > most) return most;
  }
  return result;
}

/// The next combination of `chosen` (ascending) out of n; false after the last.
bool nextChoice(std::vector<std::size_t>& chosen, std::size_t n) {
  for (std::size_t k = chosen.size(); k-- > 0;) {
    if (chosen[k] + chosen.size() - k < n) {
      ++chosen[k];
      for (std::size_t j = k + 1; j < chosen.size(); ++j) chosen[j] = chosen[j - 1] + 1;
      return true;
    }
  }
  return false;
}

}  // namespace

std::size_t minimalPairs(ControlModel model) { return model == ControlModel::kScales ? 3 : 4; }

double PickSigmas::distance(const Eigen::Vector3d& residual) const {
  return std::hypot(residual.head<2>().norm() / horizontal, residual.z() / vertical);
}

ControlFit::ControlFit(std::span<const ControlPair> pairs, const ControlOptions& options)
    : options_(options) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i].use == PairUse::kControl) given_.push_back(i);
  }
  if (given_.empty()) return;
  moving_origin_ = pairs[given_.front()].moving;
  fixed_origin_ = pairs[given_.front()].fixed;
  for (const std::size_t i : given_) {
    places_.moving.push_back(pairs[i].moving - moving_origin_);
    places_.fixed.push_back(pairs[i].fixed - fixed_origin_);
  }
}

Eigen::Vector3d ControlFit::residual(const Eigen::Affine3d& local, const ControlPair& pair) const {
  return local * (pair.moving - moving_origin_) - (pair.fixed - fixed_origin_);
}

std::vector<Eigen::Vector3d> ControlFit::residuals(const Eigen::Affine3d& local) const {
  std::vector<Eigen::Vector3d> result;
  result.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) {
    result.push_back(local * places_.moving[i] - places_.fixed[i]);
  }
  return result;
}

Eigen::Affine3d ControlFit::inFileCoordinates(const Eigen::Affine3d& local) const {
  Eigen::Affine3d file = local;
  file.translation() = fixed_origin_ + local.translation() - local.linear() * moving_origin_;
  return file;
}

/// The largest of those residuals that must be small: half of them and as many as a minimal fit
/// takes for free (Rousseeuw and Leroy 1987), two more than a minimal fit at least: with fewer,
/// chance agreement makes an outlier of an honest pair.
double ControlFit::quantile(std::vector<double> values) const {
  const std::size_t minimal = minimalPairs(options_.model);
  const std::size_t rank = std::max(size() / 2 + (minimal + 2) / 2, minimal + 2);
  return valueAtRank(values, std::min(size(), rank) - 1);
}

PickSigmas ControlFit::sigmas(const Eigen::Affine3d& local) const {
  std::vector<double> horizontal;
  std::vector<double> vertical;
  for (const Eigen::Vector3d& r : residuals(local)) {
    horizontal.push_back(r.head<2>().norm());
    vertical.push_back(std::abs(r.z()));
  }
  const auto n = static_cast<double>(size());
  const bool scales = options_.model == ControlModel::kScales;
  const double taken_plane = scales ? 2.5 : 4.0;  // parameters per coordinate
  const double taken_line = scales ? 3.0 : 4.0;
  const double plane = std::max(
      kLeastPickSigma, quantile(horizontal) / kMedianInPlane * std::sqrt(n / (n - taken_plane)));
  const double line = quantile(vertical) / kMedianOnLine * std::sqrt(n / (n - taken_line));
  // Nobody picks heights better than places, and half as many numbers tell less of them.
  return {plane, std::max(plane, line)};
}

std::optional<Eigen::Affine3d> ControlFit::minimalFit(
    const std::vector<std::size_t>& chosen) const {
  PairPlaces few;
  for (const std::size_t i : chosen) {
    few.moving.push_back(places_.moving[i]);
    few.fixed.push_back(places_.fixed[i]);
  }
  return fitPairs(few, std::vector<double>(chosen.size(), 1.0), options_.model);
}

std::optional<Eigen::Affine3d> ControlFit::leastMedian() const {
  std::optional<Eigen::Affine3d> best;
  double best_value = std::numeric_limits<double>::max();
  const auto consider = [&](const std::optional<Eigen::Affine3d>& pose) {
    if (!pose) return;
    std::vector<double> distances;
    for (const Eigen::Vector3d& r : residuals(*pose)) distances.push_back(r.norm());
    const double value = quantile(std::move(distances));
    if (value < best_value) {
      best_value = value;
      best = pose;
    }
  };
  consider(fit(std::vector<double>(size(), 1.0)));
  const std::size_t minimal = minimalPairs(options_.model);
  std::vector<std::size_t> chosen(minimal);
  for (std::size_t k = 0; k < minimal; ++k) chosen[k] = k;
  if (choices(size(), minimal, kStarts + 1) <= kStarts) {
    do {
      throwIfInterrupted();
      consider(minimalFit(chosen));
    } while (nextChoice(chosen, size()));
    return best;
  }
  Random random(static_cast<std::uint64_t>(options_.seed));
  for (std::size_t k = 0; k < kStarts; ++k) {
    throwIfInterrupted();
    for (std::size_t j = 0; j < minimal;) {
      chosen[j] = random.below(size());
      const auto end = chosen.begin() + static_cast<std::ptrdiff_t>(j);
      if (std::find(chosen.begin(), end, chosen[j]) == end) ++j;
    }
    consider(minimalFit(chosen));
  }
  return best;
}

std::optional<Eigen::Affine3d> ControlFit::reweighted(const Eigen::Affine3d& start,
                                                      const PickSigmas& sigmas,
                                                      std::vector<double>& weights) const {
  Eigen::Affine3d local = start;
  std::vector<Eigen::Vector3d> before = residuals(local);
  for (int k = 0; k < kReweights; ++k) {
    for (std::size_t i = 0; i < size(); ++i) {
      weights[i] = tukeyWeight(sigmas.distance(before[i]) / options_.tukey);
    }
    const auto next = fit(weights);
    if (!next) return std::nullopt;
    local = *next;
    const std::vector<Eigen::Vector3d> after = residuals(local);
    double change = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      change = std::max(change, (after[i] - before[i]).norm());
    }
    before = after;
    if (change < kStill) break;
  }
  return local;
}

}  // namespace agricolmap::control_points
