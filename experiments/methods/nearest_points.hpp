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
  struct Neighbour {
    std::size_t index;  ///< in the points given
    double distance;    ///< [m]
  };
  explicit NearestPoints(std::vector<Eigen::Vector3d> points);
  ~NearestPoints();
  NearestPoints(const NearestPoints&) = delete;
  NearestPoints& operator=(const NearestPoints&) = delete;

  /// The nearest point within `most` [m] of `query`. Any thread.
  std::optional<Neighbour> nearest(const Eigen::Vector3d& query, double most) const;
  const std::vector<Eigen::Vector3d>& points() const;

 private:
  struct Tree;  // nanoflann's k-d tree
  std::unique_ptr<Tree> tree_;
};

}  // namespace agricolmap::experiments
