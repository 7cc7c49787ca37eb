// Rasters with holes, and smoothing that looks past the holes.
#pragma once

#include <vector>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::paper {

/// A channel and how much of each cell is known: `weight` is 1 where the cell is known, 0 where it
/// is empty (its value is then 0 and means nothing), in between for cells of a coarser level.
struct MaskedRaster {
  Raster<float> value;
  Raster<float> weight;
};

/// Cells of `depth` interleaved floats, so that one cell of eight fills a vector register.
struct Layers {
  int rows = 0;
  int cols = 0;
  int depth = 0;
  std::vector<float> data;

  Layers() = default;
  Layers(int r, int c, int d)
      : rows(r), cols(c), depth(d), data(static_cast<std::size_t>(r) * c * d, 0.0F) {}
  float* cell(int row, int col) {
    return data.data() + (static_cast<std::size_t>(row) * cols + col) * depth;
  }
  const float* cell(int row, int col) const {
    return data.data() + (static_cast<std::size_t>(row) * cols + col) * depth;
  }
};

/// Gaussian sampled at whole cells, cut at 2.5 deviations, sum 1.
std::vector<float> gaussianKernel(double sigma);

/// Separable Gaussian over each of the 1 or 8 layers; what lies outside counts as zero.
Layers smoothed(const Layers& in, double sigma);
Raster<float> smoothed(const Raster<float>& in, double sigma);

/// Normalised convolution (Knutsson & Westin 1993): G*(w·f) / G*w where anything is known within
/// the kernel's reach, else 0. `weight` becomes G*w.
MaskedRaster smoothed(const MaskedRaster& in, double sigma);

/// Half the resolution: weighted means of 2 × 2 cells, an odd last row or column padded as unknown.
MaskedRaster halved(const MaskedRaster& in);

}  // namespace agricolmap::paper
