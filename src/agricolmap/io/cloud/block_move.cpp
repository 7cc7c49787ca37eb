#include "agricolmap/io/cloud/block_move.hpp"

namespace agricolmap::io {

void moveAll(const PointMove& move, double* x, double* y, double* z, std::size_t count) {
  if (move.displacement) {
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d point = move({x[i], y[i], z[i]});
      x[i] = point.x();
      y[i] = point.y();
      z[i] = point.z();
    }
    return;
  }
  const Eigen::Matrix4d m = move.target_from_file.matrix();
  for (std::size_t i = 0; i < count; ++i) {
    const double px = x[i];
    const double py = y[i];
    const double pz = z[i];
    x[i] = m(0, 0) * px + m(0, 1) * py + m(0, 2) * pz + m(0, 3);
    y[i] = m(1, 0) * px + m(1, 1) * py + m(1, 2) * pz + m(1, 3);
    z[i] = m(2, 0) * px + m(2, 1) * py + m(2, 2) * pz + m(2, 3);
  }
}

}  // namespace agricolmap::io
