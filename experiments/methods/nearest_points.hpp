// Nearest neighbours among points that spread over a plane: bins seen from above.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace agricolmap::experiments {

class NearestPoints {
 public:
  struct Neighbour {
    std::uint32_t index;  ///< in the points given
    double distance;      ///< in space [m]
  };
  /// `bin`: side of the bins [m]; a few points per bin are best.
  NearestPoints(std::vector<Eigen::Vector3d> points, double bin);
  /// The nearest point within `most` [m] of `query`; of equals the one given first.
  std::optional<Neighbour> nearest(const Eigen::Vector3d& query, double most) const;
  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  std::size_t binOf(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
           static_cast<std::size_t>(col);
  }
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();
  double bin_;
  int rows_ = 1;
  int cols_ = 1;
  std::vector<std::uint32_t> begin_;  ///< per bin, plus the end
  std::vector<std::uint32_t> order_;  ///< points, bin by bin
};

}  // namespace agricolmap::experiments
