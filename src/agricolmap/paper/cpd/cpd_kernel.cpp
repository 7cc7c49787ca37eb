#include "agricolmap/paper/cpd/cpd_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::paper {
namespace {

constexpr int kLanes = 8;
using Lanes = Eigen::Array<float, kLanes, 1>;
constexpr float kCutoff = 3.0F;  ///< of the kernel, in σ
constexpr double kMaxBins = 1e7;

/// Sums of one query, one per lane.
struct LaneSums {
  Lanes weight = Lanes::Zero();
  Lanes x = Lanes::Zero();
  Lanes y = Lanes::Zero();
  Lanes z = Lanes::Zero();
  Lanes square = Lanes::Zero();
};

}  // namespace

CpdMixture::CpdMixture(const std::vector<Eigen::Vector4f>& points_and_weights, float bin)
    : corner_(0.0F, 0.0F), bin_(bin) {
  const std::size_t count = points_and_weights.size();
  if (count == 0) return;
  Eigen::Vector2f low = points_and_weights.front().head<2>();
  Eigen::Vector2f high = low;
  for (const Eigen::Vector4f& p : points_and_weights) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  corner_ = low;
  // Bins without end would cost memory where a few points are far apart.
  const Eigen::Vector2d extent = (high - low).cast<double>();
  const auto bins = [&] { return ((extent / static_cast<double>(bin_)).array() + 1.0).prod(); };
  while (bins() > kMaxBins) bin_ *= 2.0F;
  cols_ = static_cast<int>((high.x() - low.x()) / bin_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / bin_) + 1;
  const auto binOf = [&](const Eigen::Vector4f& p) {
    const int col = std::min(cols_ - 1, static_cast<int>((p.x() - corner_.x()) / bin_));
    const int row = std::min(rows_ - 1, static_cast<int>((p.y() - corner_.y()) / bin_));
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
           static_cast<std::size_t>(col);
  };
  begin_.assign(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_) + 2, 0);
  for (const Eigen::Vector4f& p : points_and_weights) ++begin_[binOf(p) + 2];
  for (std::size_t i = 2; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  // The last lanes of a run may look past its end, at points or at this padding.
  for (std::vector<float>* values : {&x_, &y_, &z_, &weight_}) values->resize(count + kLanes);
  for (const Eigen::Vector4f& p : points_and_weights) {
    const std::size_t place = begin_[binOf(p) + 1]++;
    x_[place] = p.x();
    y_[place] = p.y();
    z_[place] = p.z();
    weight_[place] = p.w();
  }
  begin_.pop_back();
}

CpdSums CpdMixture::at(const Eigen::Vector3f& query, const CpdWidths& widths) const {
  CpdSums sums;
  if (rows_ == 0) return sums;
  const float radius = kCutoff * widths.sigma;
  const float u = query.x() - corner_.x();
  const float v = query.y() - corner_.y();
  const int first_row = std::max(0, static_cast<int>(std::floor((v - radius) / bin_)));
  const int last_row = std::min(rows_ - 1, static_cast<int>(std::floor((v + radius) / bin_)));
  const float horizontal = -0.5F / (widths.sigma * widths.sigma);
  const float vertical =
      widths.sigma_height > 0.0F ? -0.5F / (widths.sigma_height * widths.sigma_height) : 0.0F;
  const Lanes lane = Lanes::LinSpaced(0.0F, static_cast<float>(kLanes - 1));
  LaneSums lanes;
  for (int row = first_row; row <= last_row; ++row) {
    // Half the chord that the search circle cuts at the row's nearest line.
    const float nearest =
        std::clamp(v, static_cast<float>(row) * bin_, static_cast<float>(row + 1) * bin_);
    const float half2 = radius * radius - (nearest - v) * (nearest - v);
    if (half2 <= 0.0F) continue;
    const float half = std::sqrt(half2);
    const int first = std::max(0, static_cast<int>(std::floor((u - half) / bin_)));
    const int last = std::min(cols_ - 1, static_cast<int>(std::floor((u + half) / bin_)));
    if (first > last) continue;
    const std::size_t line = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_);
    const std::size_t end = begin_[line + static_cast<std::size_t>(last) + 1];
    for (std::size_t i = begin_[line + static_cast<std::size_t>(first)]; i < end; i += kLanes) {
      const Lanes dx = Eigen::Map<const Lanes>(x_.data() + i) - query.x();
      const Lanes dy = Eigen::Map<const Lanes>(y_.data() + i) - query.y();
      const Lanes dz = Eigen::Map<const Lanes>(z_.data() + i) - query.z();
      const Lanes square = dx * dx + dy * dy;
      Lanes kernel = (horizontal * square + vertical * dz * dz).exp();
      kernel *= Eigen::Map<const Lanes>(weight_.data() + i);
      // 1 inside the circle and the run, 0 outside; Eigen's select would make scalar code of it
      // all.
      kernel *= (1e30F * (radius * radius - square)).max(0.0F).min(1.0F);
      kernel *= (static_cast<float>(end - i) - lane).max(0.0F).min(1.0F);
      lanes.weight += kernel;
      lanes.x += kernel * dx;
      lanes.y += kernel * dy;
      lanes.z += kernel * dz;
      lanes.square += kernel * square;
    }
  }
  sums.weight = lanes.weight.sum();
  if (sums.weight > 0.0F) {
    const float scale = 1.0F / sums.weight;
    sums.mean_offset = {scale * lanes.x.sum(), scale * lanes.y.sum(), scale * lanes.z.sum()};
    sums.square = scale * lanes.square.sum();
  }
  return sums;
}

}  // namespace agricolmap::paper
