#include "agricolmap/deform/file_deformation.hpp"

#include <algorithm>
#include <utility>

namespace agricolmap::deform {

FileDeformation::FileDeformation(Deformation deformation,
                                 const Eigen::Affine3d& levelled_from_moving,
                                 const Eigen::Matrix3d& fixed_from_displacement)
    : deformation_(std::move(deformation)),
      levelled_from_moving_(levelled_from_moving),
      fixed_from_displacement_(fixed_from_displacement),
      per_metre_(1.0 / deformation_.basis().spacing()) {
  for (int i = 0; i < deformation_.basis().spans(); ++i) {
    const auto row = [&](int k) -> Eigen::Vector3d {
      return deformation_.coefficients.row(i + k).transpose();
    };
    // The uniform cubic B-spline, SplineBasis::at by powers of u.
    spans_.push_back({(row(0) + 4.0 * row(1) + row(2)) / 6.0, (row(2) - row(0)) / 2.0,
                      (row(0) - 2.0 * row(1) + row(2)) / 2.0,
                      (row(3) - row(0)) / 6.0 + (row(1) - row(2)) / 2.0});
  }
}

Eigen::Vector3d FileDeformation::at(const Eigen::Vector3d& moving_point) const {
  const Eigen::Vector3d point = levelled_from_moving_ * moving_point;
  const PathPlace place = deformation_.path().place(point.head<2>());
  const double spacing = deformation_.basis().spacing();
  const int last = deformation_.basis().spans() - 1;
  // In this order, so that what is no number is no place beyond the spline.
  const double within = std::min(std::max(0.0, place.along * per_metre_), last + 1.0);
  const int first = std::min(static_cast<int>(within), last);
  const double u = within - first;
  const Span& span = spans_[static_cast<std::size_t>(first)];
  const Eigen::Vector3d slope = (span.c1 + u * (2.0 * span.c2 + 3.0 * u * span.c3)) * per_metre_;
  // Beyond the ends it goes straight on.
  Eigen::Vector3d displacement = span.c0 + u * (span.c1 + u * (span.c2 + u * span.c3)) +
                                 (place.along - spacing * within) * slope;
  const Eigen::Vector2d ahead = deformation_.turn() * place.tangent;
  const double heading = ahead.x() * slope.y() - ahead.y() * slope.x();
  displacement.head<2>() -= place.aside * heading * ahead;
  for (const Slip& slip : deformation_.slips) {
    if (place.along >= slip.along) displacement.head<2>() += slip.offset;
  }
  return fixed_from_displacement_ * displacement;
}

}  // namespace agricolmap::deform
