#include "agricolmap/core/cloud.hpp"

namespace agricolmap {

Box3 boundingBox(const Cloud& cloud) {
  Box3 box;
  for (const Eigen::Vector3f& p : cloud.xyz) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

}  // namespace agricolmap
