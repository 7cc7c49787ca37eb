// Distance to the nearest fixed point, looked up: what makes Go-ICP's bounds cheap.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace agricolmap::experiments {

class DistanceField {
 public:
  /// Over the points' box and `margin` [m] around it, in cubes of side `cell` [m].
  DistanceField(const std::vector<Eigen::Vector3d>& points, double cell, double margin);

  /// Distance from `p` to the nearest point [m], to about half a cell; outside the field, that at
  /// its rim and the way there.
  float at(const Eigen::Vector3f& p) const {
    Eigen::Vector3f inside;
    Eigen::Vector3i index;
    for (int k = 0; k < 3; ++k) {
      inside[k] = std::min(std::max(p[k], low_[k]), high_[k]);
      index[k] = static_cast<int>((inside[k] - low_[k]) / cell_);
    }
    const float distance = distance_[offset(index)];
    return inside == p ? distance : distance + (p - inside).norm();
  }

 private:
  std::size_t offset(const Eigen::Vector3i& i) const {
    return (static_cast<std::size_t>(i.y()) * static_cast<std::size_t>(size_.x()) +
            static_cast<std::size_t>(i.x())) *
               static_cast<std::size_t>(size_.z()) +
           static_cast<std::size_t>(i.z());
  }
  void transformAxis(int axis);

  float cell_;
  Eigen::Vector3f low_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_ = Eigen::Vector3f::Zero();  ///< just inside the last cube
  Eigen::Vector3i size_ = Eigen::Vector3i::Ones();
  std::vector<float> distance_;  ///< squared [cells²] while made, then [m]
};

}  // namespace agricolmap::experiments
