#include "agricolmap/deform/strip_bins.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::deform {
namespace {

constexpr double kRobust = 2.0;  // deviations, as in the dense refinement (Cauchy)

}  // namespace

StripBins::StripBins(const map::SignalMap& fixed, const map::SignalMap& moving,
                     const Eigen::Affine2d& pose, const Path& path, const BinLayout& layout)
    : fixed_(fixed), layout_(layout) {
  for (int k = 0; k < map::kSignalChannels; ++k) used_[k] = fixed.has(k) && moving.has(k);
  const auto bins = static_cast<std::size_t>(layout.size());
  for (int b = 0; b < layout.size(); ++b) {
    ahead_.emplace_back((pose.linear() * path.tangent(layout.middle(b))).normalized());
  }
  const std::size_t all = moving.weight.size();
  std::vector<int> bin_of(all, -1);
  std::vector<Cell> unsorted(all);
  parallelFor(static_cast<std::size_t>(moving.frame.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < moving.frame.cols; ++c) {
      const std::size_t i = moving.weight.index(r, c);
      if (moving.weight[i] < refine::kMinSeen) continue;
      const Eigen::Vector2d p = moving.frame.centre(r, c);
      const PathPlace place = path.place(p);
      const int along =
          std::clamp(static_cast<int>(place.along / layout.step()), 0, layout.count - 1);
      bin_of[i] = place.aside >= 0.0 ? layout.count + along : along;
      const Eigen::Vector2f at = fixed.frame.cellOf(pose * p).cast<float>();
      Cell& cell = unsorted[i];
      cell = {at.x(),
              at.y(),
              static_cast<float>(place.along - layout.middle(along)),
              static_cast<float>(place.aside),
              moving.weight[i],
              {}};
      for (int k = 0; k < map::kSignalChannels; ++k) cell.value[k] = moving.channel[k][i];
    }
  });
  begins_.assign(bins + 1, 0);
  for (const int bin : bin_of) {
    if (bin >= 0) ++begins_[static_cast<std::size_t>(bin) + 1];
  }
  for (std::size_t b = 0; b < bins; ++b) begins_[b + 1] += begins_[b];
  cells_.resize(begins_.back());
  std::vector<std::size_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t i = 0; i < all; ++i) {
    if (bin_of[i] >= 0) cells_[next[static_cast<std::size_t>(bin_of[i])]++] = unsorted[i];
  }
}

template <typename Body>
void StripBins::forCells(int bin, const BinMotion& motion, const Body& body) const {
  const auto b = static_cast<std::size_t>(bin);
  const auto inv_cell = static_cast<float>(1.0 / fixed_.frame.cell);
  const Eigen::Vector2d& ahead = ahead_[b];
  const double heading = ahead.x() * motion.slope.y() - ahead.y() * motion.slope.x();
  const Eigen::Vector2f shift = (motion.shift / fixed_.frame.cell).cast<float>();
  const Eigen::Vector2f along = (motion.slope / fixed_.frame.cell).cast<float>();
  const Eigen::Vector2f aside = (-heading * ahead / fixed_.frame.cell).cast<float>();
  for (std::size_t i = begins_[b]; i < begins_[b + 1]; ++i) {
    const Cell& cell = cells_[i];
    const float col = cell.col + shift.x() + cell.ahead * along.x() + cell.aside * aside.x();
    const float row = cell.row + shift.y() + cell.ahead * along.y() + cell.aside * aside.y();
    const refine::Look look = refine::lookAt(fixed_, inv_cell, col, row);
    if (look.seen) body(cell, look);
  }
}

std::vector<BinSums> StripBins::sums(const std::vector<BinMotion>& motions,
                                     const refine::Noise& noise) const {
  std::vector<BinSums> result(motions.size());
  parallelFor(motions.size(), [&](std::size_t b) {
    BinSums sums;
    const Eigen::Vector2d ahead = ahead_[b];
    double normal[6] = {};
    double right[3] = {};
    forCells(static_cast<int>(b), motions[b], [&](const Cell& cell, const refine::Look& look) {
      const auto weight = static_cast<double>(cell.weight);
      const auto t = static_cast<double>(cell.aside);
      double aa = 0.0, ac = 0.0, cc = 0.0, a = 0.0, c = 0.0;
      for (int k = 0; k < map::kSignalChannels; ++k) {
        if (!used_[k]) continue;
        const double residual =
            static_cast<double>(cell.value[k]) - noise.gain[k] * static_cast<double>(look.value[k]);
        const double u = residual / (kRobust * noise.deviation[k]);
        const double w = weight / (1.0 + u * u);
        sums.cost += 0.5 * weight * kRobust * kRobust * std::log1p(u * u);
        const double scale = w / (noise.deviation[k] * noise.deviation[k]);
        const double gx = noise.gain[k] * static_cast<double>(look.dx[k]);
        const double gy = noise.gain[k] * static_cast<double>(look.dy[k]);
        const double ga = ahead.x() * gx + ahead.y() * gy;
        const double gc = ahead.x() * gy - ahead.y() * gx;
        aa += scale * ga * ga;
        ac += scale * ga * gc;
        cc += scale * gc * gc;
        a += scale * residual * ga;
        c += scale * residual * gc;
      }
      normal[0] += aa;
      normal[1] += ac;
      normal[2] += cc;
      normal[3] -= t * aa;
      normal[4] -= t * ac;
      normal[5] += t * t * aa;
      right[0] += a;
      right[1] += c;
      right[2] -= t * a;
      sums.cells += weight;
    });
    sums.normal << normal[0], normal[1], normal[3], normal[1], normal[2], normal[4], normal[3],
        normal[4], normal[5];
    sums.right = Eigen::Vector3d(right[0], right[1], right[2]);
    result[b] = sums;
  });
  return result;
}

void StripBins::updateNoise(const std::vector<BinMotion>& motions, refine::Noise& noise) const {
  std::vector<refine::Products> parts(motions.size());
  parallelFor(motions.size(), [&](std::size_t b) {
    refine::Products part;
    forCells(static_cast<int>(b), motions[b], [&](const Cell& cell, const refine::Look& look) {
      for (int k = 0; k < map::kSignalChannels; ++k) {
        if (!used_[k]) continue;
        const auto f = static_cast<double>(look.value[k]);
        const auto m = static_cast<double>(cell.value[k]);
        const double residual = m - noise.gain[k] * f;
        const double u = residual / (kRobust * noise.deviation[k]);
        part.add(k, static_cast<double>(cell.weight) / (1.0 + u * u), f, m, residual);
      }
    });
    parts[b] = part;
  });
  refine::Products all;
  for (const refine::Products& part : parts) all += part;
  all.update(noise);
}

}  // namespace agricolmap::deform
