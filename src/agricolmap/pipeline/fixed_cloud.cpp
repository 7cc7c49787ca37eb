#include "agricolmap/pipeline/fixed_cloud.hpp"

#include <algorithm>

#include "agricolmap/pipeline/pair_maps.hpp"

namespace agricolmap::pipeline {

Eigen::Vector3d FixedCloud::mean() const {
  const std::scoped_lock lock(mutex_);
  if (!mean_) mean_ = meanOf(points_);
  return *mean_;
}

/// Of the caller, who holds the lock.
FixedCloud::Level& FixedCloud::levelFor(const map::LevelOptions& options) const {
  const auto found = std::find_if(levels_.begin(), levels_.end(), [&](const Level& level) {
    return level.options.cell == options.cell && level.options.percentile == options.percentile &&
           level.options.max_tilt_deg == options.max_tilt_deg;
  });
  if (found != levels_.end()) return *found;
  map::Levelling levelling = map::levelCloud(points_, Eigen::Affine3d::Identity(), options);
  return levels_.emplace_back(Level{options, levelling, std::nullopt});
}

map::Levelling FixedCloud::levelling(const map::LevelOptions& options) const {
  const std::scoped_lock lock(mutex_);
  return levelFor(options).levelling;
}

map::Footprint FixedCloud::footprint(const map::LevelOptions& options) const {
  const std::scoped_lock lock(mutex_);
  Level& level = levelFor(options);
  if (!level.footprint) {
    level.footprint = map::footprintOf(points_, level.levelling.levelled_from_guess);
  }
  return *level.footprint;
}

}  // namespace agricolmap::pipeline
