// A fixed cloud that several strips are registered to: what they ask of all its points is found
// once.
#pragma once

#include <Eigen/Geometry>
#include <list>
#include <mutex>
#include <optional>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/level.hpp"

namespace agricolmap::pipeline {

/// Can be asked by several threads at once, where its points can be passed so. Answers are those of
/// a cloud that is asked for the first time, to the bit.
class FixedCloud {
 public:
  /// `points` must outlive it.
  explicit FixedCloud(const PointStream& points) : points_(points) {}

  const PointStream& points() const { return points_; }
  const CloudFacts& facts() const { return points_.facts(); }

  /// Mean of its points in the file's coordinates [m].
  Eigen::Vector3d mean() const;
  /// The ground plane, no guess applied.
  map::Levelling levelling(const map::LevelOptions& options) const;
  /// Where its points are in the levelled frame.
  map::Footprint footprint(const map::LevelOptions& options) const;

 private:
  struct Level {
    map::LevelOptions options;
    map::Levelling levelling;
    std::optional<map::Footprint> footprint;
  };
  Level& levelFor(const map::LevelOptions& options) const;

  const PointStream& points_;
  mutable std::mutex mutex_;  ///< held while an answer is found: who asks for the same waits
  mutable std::optional<Eigen::Vector3d> mean_;
  mutable std::list<Level> levels_;
};

}  // namespace agricolmap::pipeline
