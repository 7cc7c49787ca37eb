#include "agricolmap/paper/describe/daisy.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/paper/describe/descriptor_map.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, DaisyOptions& options) {
  table.number("radius", options.radius, 3.0, 60.0, "cells",
               "radius of the outer ring at the finest level");
  table.number("shrink", options.shrink, 0.5, 1.0, "",
               "factor of the radius in cells from level to level");
  table.choice("norm", options.norm, {"partial", "full"},
               "unit length per sample point or over the whole descriptor");
}

namespace {

constexpr std::size_t kRowGrain = 8;
constexpr double kGradientSigma = 1.0;  ///< smoothing before gradients are taken [cells]
constexpr float kKnownShare = 0.35F;    ///< of a sample point's Gaussian that must be known
constexpr float kTiny = 1e-12F;

/// Adds max(0, gradient along 45°·k) of a smoothed channel, weighted by what is known.
void addOrientations(const MaskedRaster& channel, const Raster<float>& weight, Layers& layers) {
  std::array<float, kDaisyOrientations> cosine{};
  std::array<float, kDaisyOrientations> sine{};
  for (std::size_t k = 0; k < cosine.size(); ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / kDaisyOrientations;
    cosine[k] = static_cast<float>(std::cos(angle));
    sine[k] = static_cast<float>(std::sin(angle));
  }
  const MaskedRaster smooth = smoothed(channel, kGradientSigma);
  const Raster<float>& f = smooth.value;
  parallelFor(
      static_cast<std::size_t>(f.rows()),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        const int south = std::max(row - 1, 0);
        const int north = std::min(row + 1, f.rows() - 1);
        for (int col = 0; col < f.cols(); ++col) {
          if (weight(row, col) <= 0.0F) continue;
          const int west = std::max(col - 1, 0);
          const int east = std::min(col + 1, f.cols() - 1);
          // A neighbour beyond the kernel's reach has no value to differ from.
          const auto known = [&](int a, int b) { return smooth.weight(a, b) > 1e-4F; };
          const float gx =
              known(row, west) && known(row, east) ? f(row, east) - f(row, west) : 0.0F;
          const float gy =
              known(south, col) && known(north, col) ? f(north, col) - f(south, col) : 0.0F;
          float* cell = layers.cell(row, col);
          for (std::size_t k = 0; k < cosine.size(); ++k) {
            cell[k] += weight(row, col) * std::max(0.0F, gx * cosine[k] + gy * sine[k]);
          }
        }
      },
      kRowGrain);
}

/// Orientation maps smoothed for one ring, divided by the share of known cells.
struct Ring {
  Layers layers;
  Raster<float> known;
};

void normaliseByKnown(Ring& ring, bool unit_length) {
  parallelFor(
      static_cast<std::size_t>(ring.layers.rows),
      [&](std::size_t r) {
        const int row = static_cast<int>(r);
        for (int col = 0; col < ring.layers.cols; ++col) {
          if (ring.known(row, col) < kKnownShare) continue;
          float* cell = ring.layers.cell(row, col);
          float scale = 0.0F;
          if (unit_length) {
            float norm2 = 0.0F;
            for (int k = 0; k < kDaisyOrientations; ++k) norm2 += cell[k] * cell[k];
            scale = norm2 > kTiny ? 1.0F / std::sqrt(norm2) : 0.0F;
          } else {
            scale = 1.0F / ring.known(row, col);
          }
          for (int k = 0; k < kDaisyOrientations; ++k) cell[k] *= scale;
        }
      },
      kRowGrain);
}

struct SamplePoint {
  int ring;
  int row;
  int col;
};

std::array<SamplePoint, kDaisyPoints> samplePoints(double radius) {
  std::array<SamplePoint, kDaisyPoints> points{};
  std::size_t next = 1;
  for (int ring = 0; ring < kDaisyRings; ++ring) {
    const double r = radius * (ring + 1) / kDaisyRings;
    for (int k = 0; k < kDaisyRingPoints; ++k) {
      const double turn = (ring % 2 == 1 ? 0.5 : 0.0) + k;
      const double angle = 2.0 * std::numbers::pi * turn / kDaisyRingPoints;
      points[next++] = {ring, static_cast<int>(std::lround(r * std::sin(angle))),
                        static_cast<int>(std::lround(r * std::cos(angle)))};
    }
  }
  return points;
}

/// A sample point of a row's cells: the part of the row for which it lies on the raster, and the
/// ring's cells and shares there, which are those of column `first`.
struct RowPoint {
  int first = 0;
  int last = 0;
  const float* cells = nullptr;
  const float* known = nullptr;
};

RowPoint rowPoint(const std::array<Ring, kDaisyRings>& rings, const SamplePoint& point, int row) {
  const Ring& ring = rings[static_cast<std::size_t>(point.ring)];
  const int r = row + point.row;
  RowPoint result;
  if (r < 0 || r >= ring.known.rows()) return result;
  result.first = std::max(0, -point.col);
  result.last = std::min(ring.known.cols(), ring.known.cols() - point.col);
  if (result.first >= result.last) return {};
  result.cells = ring.layers.cell(r, result.first + point.col);
  result.known = ring.known.row(r) + result.first + point.col;
  return result;
}

/// Bits and squared lengths of a row's descriptors. Point by point and not cell by cell: each sum
/// waits for its last addition, but those of neighbouring cells do not wait for each other.
void measureRow(const std::array<Ring, kDaisyRings>& rings,
                const std::array<SamplePoint, kDaisyPoints>& points, int row,
                std::vector<std::uint32_t>& bits, std::vector<float>& norm2) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RowPoint at = rowPoint(rings, points[i], row);
    for (int col = at.first; col < at.last; ++col) {
      if (at.known[col - at.first] < kKnownShare) continue;
      const auto c = static_cast<std::size_t>(col);
      const float* cell =
          at.cells + static_cast<std::ptrdiff_t>(col - at.first) * kDaisyOrientations;
      float sum = norm2[c];
      for (int k = 0; k < kDaisyOrientations; ++k) sum += cell[k] * cell[k];
      norm2[c] = sum;
      bits[c] |= 1U << i;
    }
  }
}

/// Writes the descriptors of one row of cells.
void writeRow(const std::array<Ring, kDaisyRings>& rings,
              const std::array<SamplePoint, kDaisyPoints>& points, int row, bool full,
              DescriptorMap& out) {
  const Raster<float>& around = rings.front().known;
  const auto cols = static_cast<std::size_t>(around.cols());
  std::vector<std::uint32_t> bits(cols);
  std::vector<float> norm2(cols);
  measureRow(rings, points, row, bits, norm2);
  std::vector<float> scale(cols, kDaisyScalePartial);
  for (std::size_t c = 0; full && c < cols; ++c) {
    // Points on unknown ground take no share of the unit length.
    const auto count = static_cast<float>(std::popcount(bits[c]));
    scale[c] =
        norm2[c] > kTiny ? kDaisyScaleFull * std::sqrt(count / kDaisyPoints / norm2[c]) : 0.0F;
  }
  std::array<RowPoint, kDaisyPoints> at;
  for (std::size_t i = 0; i < points.size(); ++i) at[i] = rowPoint(rings, points[i], row);
  for (int col = 0; col < around.cols(); ++col) {
    // What lies off the known ground is never matched.
    if (around(row, col) < kKnownShare) continue;
    const auto c = static_cast<std::size_t>(col);
    const std::size_t cell = around.index(row, col);
    out.known[cell] |= bits[c];
    // Together first, so that the conversion vectorises.
    std::array<float, kDaisySize> values{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((bits[c] >> i & 1U) == 0) continue;
      std::copy_n(at[i].cells + static_cast<std::ptrdiff_t>(col - at[i].first) * kDaisyOrientations,
                  kDaisyOrientations, values.data() + i * kDaisyOrientations);
    }
    const float stretch = scale[c];
    std::uint8_t* bytes = out.bytes.data() + cell * DescriptorMap::kStride;
    for (std::size_t k = 0; k < values.size(); ++k) {
      bytes[k] = static_cast<std::uint8_t>(std::min(255.0F, stretch * values[k] + 0.5F));
    }
  }
}

}  // namespace

void computeDaisy(std::span<const MaskedRaster> channels, const DaisyOptions& options,
                  DescriptorMap& out) {
  const Raster<float>& weight = channels.front().weight;
  Layers layers(weight.rows(), weight.cols(), kDaisyOrientations);
  for (const MaskedRaster& channel : channels) addOrientations(channel, weight, layers);
  // Each ring smooths the one inside it a little more (Tola et al., Sec. 3.2).
  const bool full = options.norm == DaisyNorm::kFull;
  std::array<Ring, kDaisyRings> rings;
  double sigma = 0.0;
  for (int ring = 0; ring < kDaisyRings; ++ring) {
    const auto i = static_cast<std::size_t>(ring);
    const double target = options.radius * (ring + 1) / (2.0 * kDaisyRings);
    const double step = std::sqrt(target * target - sigma * sigma);
    rings[i].layers = smoothed(ring == 0 ? layers : rings[i - 1].layers, step);
    rings[i].known = smoothed(ring == 0 ? weight : rings[i - 1].known, step);
    sigma = target;
  }
  for (Ring& ring : rings) normaliseByKnown(ring, !full);
  const auto points = samplePoints(options.radius);
  parallelFor(
      static_cast<std::size_t>(weight.rows()),
      [&](std::size_t r) { writeRow(rings, points, static_cast<int>(r), full, out); }, kRowGrain);
}

}  // namespace agricolmap::paper
