#include "agricolmap/map/ground_plane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::map {
namespace {

constexpr std::ptrdiff_t kMinPointsPerCell = 3;
constexpr int kIterations = 15;
/// Points so close to a plane may be of it: a field's clods and tracks [m].
constexpr double kRelief = 0.06;
/// A sought plane begins with points so far from it and closes in [m].
constexpr double kFirstRelief = 0.2;
/// Points so far below a plane speak against its being the ground [m].
constexpr double kBelow = 0.1;
/// Heights among the low points at which a plane under the canopy is sought.
constexpr double kStarts[] = {0.02, 0.1, 0.25, 0.5};

/// One step of weighted least squares.
Eigen::Vector3d solvePlane(const LevelPoints& points, const std::vector<double>& weights,
                           const Eigen::Vector3d& centre, double cell) {
  Eigen::Matrix3d normal = Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  normal *= 1e-3 * cell * cell;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d d = points[i] - centre;
    const Eigen::Vector3d row(d.x(), d.y(), 1.0);
    normal += weights[i] * row * row.transpose();
    right += weights[i] * d.z() * row;
  }
  return normal.ldlt().solve(right);
}

double supportOf(const GroundPlane& plane, const LevelPoints& points,
                 const Eigen::Vector3d& centre) {
  double support = 0.0;
  for (const Eigen::Vector3d& point : points) {
    const double over = plane.over(point, centre);
    support += tukeyWeight(over / kRelief) - (over < -kBelow ? 1.0 : 0.0);
  }
  return support;
}

/// A point and its cell.
struct Place {
  std::int64_t row = 0;
  std::int64_t col = 0;
  std::size_t point = 0;
};

/// Stable, by counting: cells are few beside the points, and this is done many times.
std::vector<Place> sortedBy(std::vector<Place> places, std::int64_t Place::*key) {
  if (places.empty()) return places;
  const auto [low, high] =
      std::minmax_element(places.begin(), places.end(),
                          [&](const Place& a, const Place& b) { return a.*key < b.*key; });
  const std::int64_t first = (*low).*key;
  std::vector<std::size_t> next(static_cast<std::size_t>((*high).*key - first) + 2, 0);
  for (const Place& place : places) ++next[static_cast<std::size_t>(place.*key - first) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Place> sorted(places.size());
  for (const Place& place : places) {
    sorted[next[static_cast<std::size_t>(place.*key - first)]++] = place;
  }
  return sorted;
}

}  // namespace

Eigen::Vector3d GroundPlane::normal() const {
  return Eigen::Vector3d(-slope_and_height.x(), -slope_and_height.y(), 1.0).normalized();
}

LevelPoints lowPoints(const LevelPoints& points, double cell, double percentile) {
  std::vector<Place> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i] = {static_cast<std::int64_t>(std::floor(points[i].y() / cell)),
                 static_cast<std::int64_t>(std::floor(points[i].x() / cell)), i};
  }
  places = sortedBy(sortedBy(std::move(places), &Place::col), &Place::row);
  LevelPoints low;
  for (auto begin = places.begin(); begin != places.end();) {
    auto end = begin;
    while (end != places.end() && end->row == begin->row && end->col == begin->col) ++end;
    const auto count = end - begin;
    if (count >= kMinPointsPerCell) {
      const auto nth = begin + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(count));
      std::nth_element(begin, nth, end, [&](const Place& a, const Place& b) {
        return points[a.point].z() < points[b.point].z();
      });
      low.push_back(points[nth->point]);
    }
    begin = end;
  }
  return low;
}

GroundPlane fitPlane(const LevelPoints& points, const Eigen::Vector3d& centre, double cell) {
  GroundPlane plane;
  std::vector<double> weights(points.size(), 1.0);
  std::vector<double> absolute(points.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    plane.slope_and_height = solvePlane(points, weights, centre, cell);
    for (std::size_t i = 0; i < points.size(); ++i) {
      absolute[i] = std::abs(plane.over(points[i], centre));
    }
    plane.deviation = deviationFrom(std::vector<double>(absolute));
    const double limit = 4.685 * std::max(plane.deviation, 1e-4);
    for (std::size_t i = 0; i < points.size(); ++i) weights[i] = tukeyWeight(absolute[i] / limit);
  }
  return plane;
}

SupportedPlane findPlaneUnder(const LevelPoints& points, const Eigen::Vector3d& centre,
                              double cell) {
  std::vector<double> heights(points.size());
  std::transform(points.begin(), points.end(), heights.begin(),
                 [&](const Eigen::Vector3d& point) { return point.z() - centre.z(); });
  std::sort(heights.begin(), heights.end());
  SupportedPlane best;
  best.support = -1e300;
  std::vector<double> weights(points.size());
  for (const double start : kStarts) {
    const auto place = static_cast<std::size_t>(start * static_cast<double>(heights.size()));
    SupportedPlane found;
    found.plane.slope_and_height.z() = heights[std::min(place, heights.size() - 1)];
    double limit = kFirstRelief;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        weights[i] = tukeyWeight(found.plane.over(points[i], centre) / limit);
      }
      found.plane.slope_and_height = solvePlane(points, weights, centre, cell);
      limit = std::max(kRelief, 0.8 * limit);
    }
    found.support = supportOf(found.plane, points, centre);
    if (found.support > best.support) best = found;
  }
  std::vector<double> near, below;
  for (const Eigen::Vector3d& point : points) {
    const double over = best.plane.over(point, centre);
    if (std::abs(over) < kRelief) near.push_back(std::abs(over));
    if (over < 0.0) below.push_back(-over);
  }
  best.share = static_cast<double>(near.size()) / static_cast<double>(points.size());
  best.plane.deviation = near.empty() ? kRelief : deviationFrom(near);
  if (!below.empty()) {
    best.plane.deviation = std::max(best.plane.deviation, deviationFrom(below));
  }
  return best;
}

}  // namespace agricolmap::map
