#include "agricolmap/paper/cpd/cpd_level.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::paper {
namespace {

constexpr std::size_t kChunk = 256;
/// Points are merged to squares of this many σ.
constexpr double kSquare = 0.5;
/// Side of the squares that measure how much ground the fixed vegetation covers [m].
constexpr double kCoverSquare = 0.5;

using Points = std::vector<map::VegetationPoint>;

map::Box2 boxOf(const Points& points) {
  map::Box2 box;
  for (const map::VegetationPoint& p : points) box.extend(p.position);
  return box;
}

/// The points, cropped, of equal weight (greener ones lie on the sunny side of plants, and would
/// draw there), and few enough.
Points prepare(const Points& points, const map::Box2& crop, const CpdOptions& options) {
  Points kept;
  for (const map::VegetationPoint& p : points) {
    if (!crop.contains(p.position) || !(p.weight > 0.0)) continue;
    kept.push_back(p);
    kept.back().weight = 1.0;
  }
  return map::thinToAtMost(kept, static_cast<std::size_t>(options.max_points));
}

std::vector<Eigen::Vector4f> asFloats(const Points& points, const CpdPose& pose) {
  std::vector<Eigen::Vector4f> floats(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    floats[i].head<3>() = applyPose(pose, points[i].position, points[i].height).cast<float>();
    floats[i].w() = static_cast<float>(points[i].weight);
  }
  return floats;
}

/// Least margin of the points that count as data: the border, but never so wide that less than a
/// third of the points is left.
double dataMargin(const Points& moving, double border) {
  constexpr double kLeast = 1.0 / 3.0;
  std::vector<double> margins(moving.size());
  std::transform(moving.begin(), moving.end(), margins.begin(),
                 [](const map::VegetationPoint& p) { return p.margin; });
  return std::min(border, quantile(margins, 1.0 - kLeast));
}

}  // namespace

CpdClouds makeCpdClouds(const Points& fixed, const Points& moving, const CpdPose& start,
                        const CpdOptions& options) {
  CpdClouds result;
  const map::Box2 box = boxOf(moving);
  map::Box2 crop;
  result.corners = cornersOf(box);
  for (Eigen::Vector2d& corner : result.corners) {
    crop.extend(start.plane * corner);
    corner -= box.center();
  }
  const double margin = options.max_motion + 3.0 * options.sigma_start;
  crop.min().array() -= margin;
  crop.max().array() += margin;
  result.fixed = prepare(fixed, crop, options);
  result.moving = prepare(moving, box, options);
  result.moving_origin = box.center();
  result.fixed_origin = start.plane * box.center();
  double weight = 0.0;
  double height = 0.0;
  double square = 0.0;
  for (map::VegetationPoint& p : result.fixed) {
    p.position -= result.fixed_origin;
    weight += p.weight;
    height += p.weight * p.height;
    square += p.weight * p.height * p.height;
  }
  for (map::VegetationPoint& p : result.moving) p.position -= result.moving_origin;
  if (weight > 0.0) {
    const double covered =
        static_cast<double>(map::thinVegetation(result.fixed, kCoverSquare).size());
    result.density = weight / (covered * kCoverSquare * kCoverSquare);
    height /= weight;
    result.height_range = std::sqrt(12.0 * std::max(0.0, square / weight - height * height));
  }
  return result;
}

CpdLevel makeCpdLevel(const CpdClouds& clouds, const CpdPose& pose, double sigma, bool last,
                      const CpdOptions& options) {
  const auto merged = [&](const Points& points) {
    return last ? points : map::thinVegetation(points, kSquare * sigma);
  };
  const auto bin = static_cast<float>(sigma);
  CpdLevel level{sigma, CpdMixture(asFloats(merged(clouds.fixed), {}), bin), {}};
  const Points moving = merged(clouds.moving);
  // The moving points' own means are taken where they lie in the fixed frame, under its isotropic
  // kernel, and carried back: poses of one level differ too little to matter.
  const std::vector<Eigen::Vector4f> moved = asFloats(moving, pose);
  const CpdMixture own(moved, bin);
  const CpdWidths widths{bin, static_cast<float>(options.sigma_height)};
  const Eigen::Matrix2d back = pose.plane.linear().inverse();
  const double margin = dataMargin(moving, options.border * sigma);
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving[i].margin >= margin) chosen.push_back(i);
  }
  level.data.resize(chosen.size());
  parallelFor(
      chosen.size(),
      [&](std::size_t i) {
        const map::VegetationPoint& p = moving[chosen[i]];
        const Eigen::Vector3d offset =
            own.at(moved[chosen[i]].head<3>(), widths).mean_offset.cast<double>();
        CpdDatum& datum = level.data[i];
        datum.point = p;
        datum.mean << p.position + back * offset.head<2>(), p.height + offset.z();
      },
      kChunk);
  return level;
}

}  // namespace agricolmap::paper
