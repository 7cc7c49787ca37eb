#include "agricolmap/paper/describe/fpfh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/paper/describe/descriptor_map.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, FpfhOptions& options) {
  table.number("radius", options.radius, 1.5, 8.0, "cells", "radius of the neighbourhood");
  table.number("exaggeration", options.exaggeration, 1.0, 20.0, "",
               "factor of the heights; not in the paper");
}

namespace {

constexpr std::size_t kRowGrain = 8;
constexpr double kSurfaceSigma = 1.0;  ///< smoothing of the heights before normals [cells]
constexpr float kKnownShare = 0.25F;   ///< of the smoothing kernel that must be known
constexpr std::size_t kPadded = 48;    ///< histogram with padding, whole vector registers

/// A neighbour at a fixed place: offset in cells and its share in the weighted sum.
struct Neighbour {
  int row;
  int col;
  double distance;  ///< [cells]
};

/// Every other cell of a disc, as on a chess board: heights are smoothed over a cell, so the cells
/// between would only repeat what these say.
std::vector<Neighbour> neighbourhood(double radius) {
  std::vector<Neighbour> result;
  const int reach = static_cast<int>(radius);
  for (int row = -reach; row <= reach; ++row) {
    for (int col = -reach; col <= reach; ++col) {
      const double distance = std::hypot(row, col);
      if (distance > 0.0 && distance <= radius && (row + col) % 2 == 0) {
        result.push_back({row, col, distance});
      }
    }
  }
  return result;
}

/// The surface in units of cells: heights and unit normals, by planes so that loops vectorise.
struct Surface {
  Raster<float> z;
  Raster<float> nx;
  Raster<float> ny;
  Raster<float> nz;
  Raster<float> known;  ///< 1 or 0
};

Surface surfaceOf(const MaskedRaster& height, double cell, double exaggeration) {
  const MaskedRaster smooth = smoothed(height, kSurfaceSigma);
  const int rows = height.value.rows();
  const int cols = height.value.cols();
  Surface s{smooth.value, Raster<float>(rows, cols), Raster<float>(rows, cols),
            Raster<float>(rows, cols, 1.0F), Raster<float>(rows, cols)};
  const auto to_cells = static_cast<float>(exaggeration / cell);
  for (float& z : s.z) z *= to_cells;
  const auto known = [&](int row, int col) { return smooth.weight(row, col) >= kKnownShare; };
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int col = 0; col < cols; ++col) {
          if (!known(row, col) || row == 0 || col == 0 || row + 1 == rows || col + 1 == cols ||
              !known(row - 1, col) || !known(row + 1, col) || !known(row, col - 1) ||
              !known(row, col + 1)) {
            continue;
          }
          const float gx = 0.5F * (s.z(row, col + 1) - s.z(row, col - 1));
          const float gy = 0.5F * (s.z(row + 1, col) - s.z(row - 1, col));
          const float scale = 1.0F / std::sqrt(1.0F + gx * gx + gy * gy);
          s.nx(row, col) = -gx * scale;
          s.ny(row, col) = -gy * scale;
          s.nz(row, col) = scale;
          s.known(row, col) = 1.0F;
        }
      },
      kRowGrain);
  return s;
}

/// atan2 to 1e-3 rad, enough for bins of 0.57 rad, without branches.
inline float fastAtan2(float y, float x) {
  const float ax = std::abs(x);
  const float ay = std::abs(y);
  const float ratio = std::min(ax, ay) / (std::max(ax, ay) + 1e-20F);
  const float q = ratio * ratio;
  float angle = ((-0.0464964749F * q + 0.15931422F) * q - 0.327622764F) * q * ratio + ratio;
  angle = ay > ax ? 0.5F * std::numbers::pi_v<float> - angle : angle;
  angle = x < 0.0F ? std::numbers::pi_v<float> - angle : angle;
  return y < 0.0F ? -angle : angle;
}

inline int binOf(float value, float low, float width) {
  const int bin = static_cast<int>((value - low) * (static_cast<float>(kFpfhBins) / width));
  return std::min(std::max(bin, 0), kFpfhBins - 1);
}

/// Bins of the three angles for one row of cells and one neighbour, and 1 where both points are
/// known.
struct BinRow {
  std::vector<int> alpha;
  std::vector<int> phi;
  std::vector<int> theta;
  std::vector<int> known;
};

/// The Darboux frame's angles (Rusu et al., Eq. 1): u the normal of the source, which is the point
/// whose normal lies closer to the line between the two, v = u × d, w = u × v.
void pairAngles(const Surface& s, int row, const Neighbour& n, int first, int last, BinRow& out) {
  const auto at = [&](const Raster<float>& plane, int r, int shift) {
    return plane.row(r) + shift;
  };
  const float* z1 = at(s.z, row, 0);
  const float* x1 = at(s.nx, row, 0);
  const float* y1 = at(s.ny, row, 0);
  const float* n1 = at(s.nz, row, 0);
  const float* k1 = at(s.known, row, 0);
  const float* z2 = at(s.z, row + n.row, n.col);
  const float* x2 = at(s.nx, row + n.row, n.col);
  const float* y2 = at(s.ny, row + n.row, n.col);
  const float* n2 = at(s.nz, row + n.row, n.col);
  const float* k2 = at(s.known, row + n.row, n.col);
  int* alpha = out.alpha.data();
  int* phi_bin = out.phi.data();
  int* theta_bin = out.theta.data();
  int* known = out.known.data();
  const auto ex = static_cast<float>(n.col);
  const auto ey = static_cast<float>(n.row);
  const float flat2 = ex * ex + ey * ey;
  for (int c = first; c < last; ++c) {
    const float ez = z2[c] - z1[c];
    const float inverse = 1.0F / std::sqrt(flat2 + ez * ez);
    const float dx = ex * inverse;
    const float dy = ey * inverse;
    const float dz = ez * inverse;
    const float cos1 = x1[c] * dx + y1[c] * dy + n1[c] * dz;
    const float cos2 = x2[c] * dx + y2[c] * dy + n2[c] * dz;
    const bool swap = std::abs(cos1) < std::abs(cos2);
    const float sign = swap ? -1.0F : 1.0F;
    const float ux = swap ? x2[c] : x1[c];
    const float uy = swap ? y2[c] : y1[c];
    const float uz = swap ? n2[c] : n1[c];
    const float tx = swap ? x1[c] : x2[c];
    const float ty = swap ? y1[c] : y2[c];
    const float tz = swap ? n1[c] : n2[c];
    float vx = sign * (uy * dz - uz * dy);
    float vy = sign * (uz * dx - ux * dz);
    float vz = sign * (ux * dy - uy * dx);
    const float unit = 1.0F / std::sqrt(vx * vx + vy * vy + vz * vz + 1e-20F);
    vx *= unit;
    vy *= unit;
    vz *= unit;
    const float wx = uy * vz - uz * vy;
    const float wy = uz * vx - ux * vz;
    const float wz = ux * vy - uy * vx;
    const float phi = sign * (swap ? cos2 : cos1);
    const float theta = fastAtan2(wx * tx + wy * ty + wz * tz, ux * tx + uy * ty + uz * tz);
    alpha[c] = binOf(vx * tx + vy * ty + vz * tz, -1.0F, 2.0F);
    phi_bin[c] = binOf(phi, -1.0F, 2.0F);
    theta_bin[c] = binOf(theta, -std::numbers::pi_v<float>, 2.0F * std::numbers::pi_v<float>);
    known[c] = static_cast<int>(k1[c] * k2[c]);
  }
}

/// Counts of the Simplified Point Feature Histograms of a row; at most 255 neighbours.
void spfhRow(const Surface& s, const std::vector<Neighbour>& neighbours, int row, BinRow& bins,
             std::uint8_t* counts, std::uint8_t* pairs) {
  const int cols = s.z.cols();
  const float* known = s.known.row(row);
  int begin = 0;
  int end = cols;
  while (begin < end && known[begin] <= 0.0F) ++begin;
  while (end > begin && known[end - 1] <= 0.0F) --end;
  for (const Neighbour& n : neighbours) {
    if (row + n.row < 0 || row + n.row >= s.z.rows()) continue;
    const int first = std::max(begin, -n.col);
    const int last = std::min(end, cols - n.col);
    pairAngles(s, row, n, first, last, bins);
    for (int c = first; c < last; ++c) {
      const auto i = static_cast<std::size_t>(c);
      if (bins.known[i] == 0) continue;
      std::uint8_t* cell = counts + i * kPadded;
      ++cell[bins.alpha[i]];
      ++cell[kFpfhBins + bins.phi[i]];
      ++cell[2 * kFpfhBins + bins.theta[i]];
      ++pairs[i];
    }
  }
}

struct Spfh {
  std::vector<std::uint8_t> counts;
  std::vector<std::uint8_t> pairs;
};

/// Weights 1/distance of the neighbours, as whole numbers so large that sums of all counts just fit
/// 16 bits.
struct SumWeights {
  std::vector<std::uint16_t> whole;
  double mean = 0.0;  ///< of 1/distance
};

SumWeights sumWeights(const std::vector<Neighbour>& neighbours) {
  const auto count = static_cast<double>(neighbours.size());
  SumWeights weights;
  for (const Neighbour& n : neighbours) weights.mean += 1.0 / (count * n.distance);
  const double scale = 65535.0 / (count * count * weights.mean);
  for (const Neighbour& n : neighbours) {
    weights.whole.push_back(static_cast<std::uint16_t>(scale / n.distance));
  }
  return weights;
}

/// Weighted sum over the neighbours (Rusu et al., Eq. 4): own histogram plus the neighbours', each
/// over its distance in cells, divided by their number. Neighbours next to holes have fewer pairs
/// and count that much less.
void sumCell(const Spfh& spfh, const std::vector<Neighbour>& neighbours, const SumWeights& weights,
             int row, int col, int rows, int cols, std::uint8_t* out) {
  alignas(32) std::array<std::uint16_t, kPadded> sum{};
  unsigned pairs = 0;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const int r = row + neighbours[k].row;
    const int c = col + neighbours[k].col;
    if (r < 0 || c < 0 || r >= rows || c >= cols) continue;
    const std::size_t cell = static_cast<std::size_t>(r) * cols + c;
    const std::uint8_t* counts = spfh.counts.data() + cell * kPadded;
    const std::uint16_t weight = weights.whole[k];
    for (std::size_t j = 0; j < kPadded; ++j) {
      sum[j] = static_cast<std::uint16_t>(sum[j] + weight * counts[j]);
    }
    pairs += static_cast<unsigned>(weight) * spfh.pairs[cell];
  }
  const std::size_t own = static_cast<std::size_t>(row) * cols + col;
  const std::uint8_t* counts = spfh.counts.data() + own * kPadded;
  const auto around = static_cast<float>(pairs > 0 ? weights.mean / pairs : 0.0);
  const float here = 1.0F / static_cast<float>(spfh.pairs[own]);
  const float scale = kFpfhScale / static_cast<float>(1.0 + (pairs > 0 ? weights.mean : 0.0));
  for (std::size_t j = 0; j < kFpfhSize; ++j) {
    const float value = here * static_cast<float>(counts[j]) + around * static_cast<float>(sum[j]);
    out[j] = static_cast<std::uint8_t>(std::min(255.0F, scale * value + 0.5F));
  }
}

}  // namespace

void computeFpfh(const MaskedRaster& height, double cell, const FpfhOptions& options,
                 DescriptorMap& out) {
  const int rows = height.value.rows();
  const int cols = height.value.cols();
  const auto neighbours = neighbourhood(options.radius);
  const auto weights = sumWeights(neighbours);
  const Surface surface = surfaceOf(height, cell, options.exaggeration);
  const std::size_t cells = height.value.size();
  Spfh spfh{std::vector<std::uint8_t>(cells * kPadded), std::vector<std::uint8_t>(cells)};
  parallelFor((static_cast<std::size_t>(rows) + kRowGrain - 1) / kRowGrain, [&](std::size_t band) {
    const auto width = static_cast<std::size_t>(cols);
    BinRow bins{std::vector<int>(width), std::vector<int>(width), std::vector<int>(width),
                std::vector<int>(width)};
    const std::size_t end = std::min(static_cast<std::size_t>(rows), (band + 1) * kRowGrain);
    for (std::size_t row = band * kRowGrain; row < end; ++row) {
      spfhRow(surface, neighbours, static_cast<int>(row), bins,
              spfh.counts.data() + row * width * kPadded, spfh.pairs.data() + row * width);
    }
  });
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int col = 0; col < cols; ++col) {
          const std::size_t i = height.value.index(row, col);
          // A histogram of a few pairs says nothing: half of the neighbours must be there.
          if (std::size_t{2} * spfh.pairs[i] < neighbours.size()) continue;
          sumCell(spfh, neighbours, weights, row, col, rows, cols,
                  out.bytes.data() + i * DescriptorMap::kStride + DescriptorMap::kFpfhOffset);
          out.known[i] |= DescriptorMap::kFpfhBit;
        }
      },
      kRowGrain);
}

}  // namespace agricolmap::paper
