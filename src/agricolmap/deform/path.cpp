#include "agricolmap/deform/path.hpp"

#include <algorithm>
#include <limits>

#include "agricolmap/core/error.hpp"

namespace agricolmap::deform {

Path::Path(const std::vector<Eigen::Vector2d>& corners) {
  for (const Eigen::Vector2d& corner : corners) {
    if (!corners_.empty()) {
      const Eigen::Vector2d step = corner - corners_.back();
      const double length = step.norm();
      if (!(length > 0.0)) continue;
      directions_.emplace_back(step / length);
      ends_.push_back(ends_.back() + length);
    } else {
      ends_.push_back(0.0);
    }
    corners_.push_back(corner);
  }
  if (corners_.size() < 2) throw UsageError("a path needs two places that differ");
}

PathPlace Path::place(const Eigen::Vector2d& point) const {
  PathPlace place;
  double least = std::numeric_limits<double>::infinity();
  const std::size_t last = directions_.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const Eigen::Vector2d& direction = directions_[i];
    const Eigen::Vector2d from = point - corners_[i];
    const double low = i == 0 ? -std::numeric_limits<double>::infinity() : 0.0;
    const double high =
        i == last ? std::numeric_limits<double>::infinity() : ends_[i + 1] - ends_[i];
    const double foot = std::clamp(direction.dot(from), low, high);
    const double distance2 = (from - foot * direction).squaredNorm();
    if (distance2 >= least) continue;
    least = distance2;
    place.along = ends_[i] + foot;
    place.aside = direction.x() * from.y() - direction.y() * from.x();
    place.tangent = direction;
  }
  return place;
}

std::size_t Path::pieceAt(double along) const {
  const auto behind = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, along);
  return static_cast<std::size_t>(behind - ends_.begin()) - 1;
}

Eigen::Vector2d Path::point(double along, double aside) const {
  const std::size_t i = pieceAt(along);
  const Eigen::Vector2d& direction = directions_[i];
  return corners_[i] + (along - ends_[i]) * direction +
         aside * Eigen::Vector2d(-direction.y(), direction.x());
}

Path stretchOf(const Path& path, double from, double to) {
  std::vector<Eigen::Vector2d> corners = {path.point(from)};
  for (std::size_t i = 1; i + 1 < path.corners().size(); ++i) {
    const double along = path.ends()[i];
    if (along > from && along < to) corners.push_back(path.corners()[i]);
  }
  if (to > from) corners.push_back(path.point(to));
  return Path(corners);
}

Path straightPath(const map::StripFrame& strip) {
  const Eigen::Vector2d arm = strip.half_extent.x() * strip.axes.col(0);
  return Path({strip.centre - arm, strip.centre + arm});
}

}  // namespace agricolmap::deform
