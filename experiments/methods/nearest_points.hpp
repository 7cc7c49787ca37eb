// Nearest neighbours among points in space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace agricolmap::experiments {

class NearestPoints {
 public:
  explicit NearestPoints(std::vector<Eigen::Vector3d> points);
  ~NearestPoints();
  NearestPoints(const NearestPoints&) = delete;
  NearestPoints& operator=(const NearestPoints&) = delete;

  /// Index of the nearest point within `most` [m] of `query`. Any thread.
  std::optional<std::size_t> nearest(const Eigen::Vector3d& query, double most) const;
  const std::vector<Eigen::Vector3d>& points() const;

 private:
  struct Tree;  // nanoflann's k-d tree
  std::unique_ptr<Tree> tree_;
};

}  // namespace agricolmap::experiments
