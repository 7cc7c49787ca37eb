#include "agricolmap/simulate/picture/cloud_photo.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/convex_hull.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/report/draw/outline.hpp"
#include "agricolmap/report/draw/page.hpp"

namespace agricolmap::simulate {
namespace {

constexpr double kSurveyCell = 0.05;     // for spacing and outline [m]
constexpr double kMaxSurveyCells = 4e3;  // along a side
constexpr double kSparse = 0.06;         // of the usual count: cells with fewer are not covered
constexpr double kReachSpacings = 1.2;   // how far a point colours its surroundings
constexpr float kTopReach = 0.6F;        // of that: how far it hides what lies lower
constexpr float kLeafDepth = 0.015F;     // so far below the top the weight is a quarter [m]
constexpr float kLeastWeight = 0.02F;    // of all points on a pixel that counts as seen
constexpr int kNeighboursToFill = 4;     // of 8: more than at a straight border
constexpr int kMaxFillPasses = 8;

/// A point's place in the picture [px] and its height [m].
struct Seat {
  float x, y, z;
};

/// Cloud coordinates → pixels of the rectangle's upper left corner.
class Seating {
 public:
  Seating(const Eigen::Affine3d& ground_from_cloud, const report::View& view) {
    const Eigen::Vector2d corner(view.rect.x, view.rect.y);
    const Eigen::Vector2d zero = view.pixel(ground_from_cloud.translation().head<2>()) - corner;
    Eigen::Affine3d all;
    for (int k = 0; k < 3; ++k) {
      all.linear().col(k).head<2>() = view.direction(ground_from_cloud.linear().col(k).head<2>());
    }
    all.linear().row(2) = ground_from_cloud.linear().row(2);
    all.translation() << zero, ground_from_cloud.translation().z();
    seat_from_cloud_ = all.cast<float>();
  }
  Seat operator()(const Eigen::Vector3f& point) const {
    const Eigen::Vector3f seat = seat_from_cloud_ * point;
    return {seat.x(), seat.y(), seat.z()};
  }

 private:
  Eigen::Affine3f seat_from_cloud_ = Eigen::Affine3f::Identity();
};

/// Calls `touch(row, col, weight)` for the pixels closer than `reach`, `weight` falling from 1 to
/// 0.
template <typename Touch>
void forPixelsAround(const Seat& seat, float reach, int rows, int cols, const Touch& touch) {
  // Also keeps what is far outside from overflowing an int.
  if (!(seat.x > -reach && seat.y > -reach && seat.x < static_cast<float>(cols) + reach &&
        seat.y < static_cast<float>(rows) + reach)) {
    return;
  }
  const int left = std::max(0, static_cast<int>(std::ceil(seat.x - reach - 0.5F)));
  const int top = std::max(0, static_cast<int>(std::ceil(seat.y - reach - 0.5F)));
  const int right = std::min(cols - 1, static_cast<int>(std::floor(seat.x + reach - 0.5F)));
  const int bottom = std::min(rows - 1, static_cast<int>(std::floor(seat.y + reach - 0.5F)));
  const float scale = 1.0F / (reach * reach);
  for (int row = top; row <= bottom; ++row) {
    const float dy = static_cast<float>(row) + 0.5F - seat.y;
    for (int col = left; col <= right; ++col) {
      const float dx = static_cast<float>(col) + 0.5F - seat.x;
      const float near = 1.0F - scale * (dx * dx + dy * dy);
      if (near > 0.0F) touch(row, col, near * near);
    }
  }
}

/// Sums of colour times weight (r, g, b), and of weights.
using Sums = Raster<Eigen::Array4f>;

/// Colours pixels without one that are nearly surrounded by others, from the border inwards.
void closeGaps(Sums& sums, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    const Sums before = sums;
    for (int row = 1; row + 1 < sums.rows(); ++row) {
      for (int col = 1; col + 1 < sums.cols(); ++col) {
        if (before(row, col)(3) > 0.0F) continue;
        Eigen::Array4f mean = Eigen::Array4f::Zero();
        for (int dr = -1; dr <= 1; ++dr) {
          for (int dc = -1; dc <= 1; ++dc) {
            const Eigen::Array4f& other = before(row + dr, col + dc);
            if (other(3) > 0.0F) mean += other / other(3);
          }
        }
        if (mean(3) >= static_cast<float>(kNeighboursToFill)) sums(row, col) = mean;
      }
    }
  }
}

}  // namespace

CloudPhoto::CloudPhoto(const Cloud& cloud, const Eigen::Affine3d& ground_from_cloud)
    : cloud_(cloud), ground_from_cloud_(ground_from_cloud) {
  if (cloud.empty() || !cloud.hasColour()) {
    throw UsageError("a photo of a cloud needs points with colours");
  }
  survey();
}

void CloudPhoto::survey() {
  const Eigen::Affine3f ground_from_cloud = ground_from_cloud_.cast<float>();
  Eigen::AlignedBox2f box;
  for (const Eigen::Vector3f& point : cloud_.xyz) {
    box.extend((ground_from_cloud * point).head<2>().eval());
  }
  GridFrame frame;
  frame.cell = std::max(kSurveyCell, static_cast<double>(box.sizes().maxCoeff()) / kMaxSurveyCells);
  frame.corner = box.min().cast<double>();
  frame.cols = 1 + static_cast<int>(static_cast<double>(box.sizes().x()) / frame.cell);
  frame.rows = 1 + static_cast<int>(static_cast<double>(box.sizes().y()) / frame.cell);
  Raster<int> counts(frame.rows, frame.cols);
  const float per_cell = static_cast<float>(1.0 / frame.cell);
  for (const Eigen::Vector3f& point : cloud_.xyz) {
    const Eigen::Vector2f at = per_cell * ((ground_from_cloud * point).head<2>() - box.min());
    ++counts(std::min(static_cast<int>(at.y()), frame.rows - 1),
             std::min(static_cast<int>(at.x()), frame.cols - 1));
  }
  std::vector<int> filled;
  for (const int count : counts) {
    if (count > 0) filled.push_back(count);
  }
  const double least = kSparse * median(filled);
  std::vector<Eigen::Vector2d> covered;
  double points = 0.0;
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 0; col < frame.cols; ++col) {
      if (counts(row, col) == 0 || counts(row, col) < least) continue;
      covered.push_back(frame.centre(row, col));
      points += counts(row, col);
    }
  }
  spacing_ = frame.cell * std::sqrt(static_cast<double>(covered.size()) / points);
  outline_ = convexHull(std::move(covered));
}

Raster<std::uint32_t> CloudPhoto::shoot(const report::View& view) const {
  const int rows = view.rect.height;
  const int cols = view.rect.width;
  const Seating seating(ground_from_cloud_, view);
  const double spacing = spacing_ * view.scale;  // [px]
  const float reach = static_cast<float>(std::max(1.0, kReachSpacings * spacing));
  Raster<float> tops(rows, cols, std::numeric_limits<float>::lowest());
  for (const Eigen::Vector3f& point : cloud_.xyz) {
    const Seat seat = seating(point);
    forPixelsAround(seat, kTopReach * reach, rows, cols, [&](int row, int col, float) {
      tops(row, col) = std::max(tops(row, col), seat.z);
    });
  }
  Sums sums(rows, cols, Eigen::Array4f::Zero());
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const Seat seat = seating(cloud_.xyz[i]);
    const Rgb& rgb = cloud_.rgb[i];
    const Eigen::Array4f colour(rgb.r, rgb.g, rgb.b, 1.0F);
    forPixelsAround(seat, reach, rows, cols, [&](int row, int col, float weight) {
      const float depth = std::max(0.0F, tops(row, col) - seat.z) / kLeafDepth;
      const float hidden = 1.0F + depth * depth;
      sums(row, col) += weight / (hidden * hidden) * colour;
    });
  }
  for (Eigen::Array4f& sum : sums) {
    if (sum(3) < kLeastWeight) sum.setZero();
  }
  closeGaps(sums, std::min(kMaxFillPasses, 2 + static_cast<int>(spacing)));
  Raster<std::uint32_t> picture(rows, cols, kNothing);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (sums[i](3) <= 0.0F) continue;
    const Eigen::Array3i rgb = (sums[i].head<3>() / sums[i](3) + 0.5F).cast<int>();
    picture[i] = report::packPixel(rgb(0), rgb(1), rgb(2));
  }
  return picture;
}

}  // namespace agricolmap::simulate
