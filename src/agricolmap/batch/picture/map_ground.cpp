#include <algorithm>
#include <cmath>

#include "agricolmap/batch/picture/summary_picture.hpp"

namespace agricolmap::batch {

MapGround groundOf(const std::string& id, const PointStream& cloud) {
  constexpr double kMostCells = 1500.0;  // along the longer side: about a pixel each
  const CloudFacts& facts = cloud.facts();
  const Box3 box = cloud.box();
  const Eigen::Vector2d low = box.min.head<2>().cast<double>();
  const Eigen::Vector2d high = box.max.head<2>().cast<double>();
  map::GridOptions options;
  const double area = std::max(1e-6, (high - low).prod());
  const double spacing =
      std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, facts.points)));
  options.cell = std::max(1.5 * spacing, (high - low).maxCoeff() / kMostCells);
  options.sigma = options.cell;
  MapGround ground;
  ground.id = id;
  ground.name = facts.name;
  ground.origin = facts.origin.head<2>();
  ground.map = map::makeGridMap(cloud, Eigen::Affine3d::Identity(), map::Box2(low, high), options);
  return ground;
}

}  // namespace agricolmap::batch
