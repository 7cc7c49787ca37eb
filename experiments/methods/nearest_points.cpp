#include "experiments/methods/nearest_points.hpp"

#include <nanoflann.hpp>
#include <utility>

namespace agricolmap::experiments {
namespace {

/// The points as nanoflann asks for them.
struct Points {
  std::vector<Eigen::Vector3d> all;
  std::size_t kdtree_get_point_count() const { return all.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return all[i][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>,
                                                  Points, 3, std::size_t>;

}  // namespace

struct NearestPoints::Tree {
  explicit Tree(std::vector<Eigen::Vector3d> points)
      : data{std::move(points)}, index(3, data, {16}) {}
  Points data;
  Index index;
};

NearestPoints::NearestPoints(std::vector<Eigen::Vector3d> points)
    : tree_(std::make_unique<Tree>(std::move(points))) {}

NearestPoints::~NearestPoints() = default;

std::optional<std::size_t> NearestPoints::nearest(const Eigen::Vector3d& query, double most) const {
  std::size_t index = 0;
  double distance2 = 0.0;
  if (tree_->index.knnSearch(query.data(), 1, &index, &distance2) == 0) return std::nullopt;
  if (!(distance2 <= most * most)) return std::nullopt;
  return index;
}

const std::vector<Eigen::Vector3d>& NearestPoints::points() const { return tree_->data.all; }

}  // namespace agricolmap::experiments
