#include "agricolmap/simulate/ortho/row_heading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/simulate/field/canvas.hpp"

namespace agricolmap::simulate {
namespace {

constexpr double kCell = 0.03;       // [m]
constexpr double kFine = 0.04;       // smoothing within a row, deviation [m]
constexpr double kCoarse = 0.40;     // what is coarser is not rows, deviation [m]
constexpr double kMaxRadius = 12.0;  // [m]
constexpr double kCoarseStep = radians(0.5);
constexpr double kFineStep = radians(0.05);
constexpr double kLeastContrast = 4.0;  // of the best direction over the median one

/// Greenness of a cell and where it lies about the middle [cells].
struct Sample {
  float x = 0.0F;
  float y = 0.0F;
  float green = 0.0F;
};

/// Mean chromatic Excess Green of blocks of pixels; `weight` is 1 where there is data.
void averageGreen(const OrthoField& field, int block, Raster<float>& green, Raster<float>& weight) {
  green = Raster<float>(field.colour.rows() / block, field.colour.cols() / block);
  weight = green;
  parallelFor(static_cast<std::size_t>(green.rows()), [&](std::size_t item) {
    const int row = static_cast<int>(item);
    for (int col = 0; col < green.cols(); ++col) {
      float sum = 0.0F;
      int count = 0;
      for (int r = row * block; r < (row + 1) * block; ++r) {
        for (int c = col * block; c < (col + 1) * block; ++c) {
          if (!field.valid.empty() && field.valid(r, c) == 0) continue;
          sum += map::excessGreen(field.colour(r, c), map::ExgKind::kChromatic);
          ++count;
        }
      }
      if (2 * count < block * block) continue;
      green(row, col) = sum / static_cast<float>(count);
      weight(row, col) = 1.0F;
    }
  });
}

/// Gaussian mean of the cells with data.
Raster<float> blurred(const Raster<float>& values, const Raster<float>& weight, double sigma) {
  Raster<float> sum = values;
  Raster<float> weights = weight;
  blurRaster(sum, sigma);
  blurRaster(weights, sigma);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(1e-3F, weights[i]);
  return sum;
}

/// Greenness between the two scales in a disc, so that no direction sees more of it than another.
std::vector<Sample> samplesOf(const OrthoField& field) {
  const int block = std::max(1, static_cast<int>(std::lround(kCell / field.gsd)));
  const double cell = block * field.gsd;
  Raster<float> green;
  Raster<float> weight;
  averageGreen(field, block, green, weight);
  const Raster<float> fine = blurred(green, weight, kFine / cell);
  const Raster<float> coarse = blurred(green, weight, kCoarse / cell);
  double x = 0.0;
  double y = 0.0;
  double count = 0.0;
  for (int r = 0; r < green.rows(); ++r) {
    for (int c = 0; c < green.cols(); ++c) {
      const double w = static_cast<double>(weight(r, c));
      x += w * c;
      y += w * r;
      count += w;
    }
  }
  std::vector<Sample> samples;
  if (count == 0.0) return samples;
  x /= count;
  y /= count;
  const double radius = std::min(kMaxRadius / cell, 0.5 * std::min(green.rows(), green.cols()));
  for (int r = 0; r < green.rows(); ++r) {
    for (int c = 0; c < green.cols(); ++c) {
      if (weight(r, c) == 0.0F || std::hypot(c - x, r - y) > radius) continue;
      samples.push_back(
          {static_cast<float>(c - x), static_cast<float>(r - y), fine(r, c) - coarse(r, c)});
    }
  }
  return samples;
}

/// Share of the variance that the means of lines in this direction explain.
double explained(const std::vector<Sample>& samples, double reach, double heading) {
  const auto across_x = static_cast<float>(-std::sin(heading));
  const auto across_y = static_cast<float>(std::cos(heading));
  struct Line {
    double sum = 0.0;
    double count = 0.0;
  };
  std::vector<Line> lines(static_cast<std::size_t>(2.0 * reach) + 3);
  const auto middle = static_cast<float>(reach + 1.0);
  double squares = 0.0;
  for (const Sample& s : samples) {
    Line& line = lines[static_cast<std::size_t>(across_x * s.x + across_y * s.y + middle)];
    line.sum += static_cast<double>(s.green);
    line.count += 1.0;
    squares += static_cast<double>(s.green) * static_cast<double>(s.green);
  }
  double between = 0.0;
  for (const Line& line : lines) {
    if (line.count > 0.0) between += line.sum * line.sum / line.count;
  }
  return squares > 0.0 ? between / squares : 0.0;
}

std::vector<double> explainedBy(const std::vector<Sample>& samples, double reach, double first,
                                double step, int count) {
  std::vector<double> shares(static_cast<std::size_t>(count));
  parallelFor(shares.size(), [&](std::size_t i) {
    shares[i] = explained(samples, reach, first + step * static_cast<double>(i));
  });
  return shares;
}

}  // namespace

double findRowHeading(const OrthoField& field) {
  const std::vector<Sample> samples = samplesOf(field);
  double reach = 0.0;
  for (const Sample& s : samples) {
    reach = std::max(reach, std::hypot(static_cast<double>(s.x), static_cast<double>(s.y)));
  }
  const double quarter = 0.5 * std::numbers::pi;
  std::vector<double> shares = explainedBy(samples, reach, -quarter, kCoarseStep, 360);
  const auto best = std::max_element(shares.begin(), shares.end());
  const double peak = *best;
  const double coarse = -quarter + kCoarseStep * static_cast<double>(best - shares.begin());
  if (!(peak > kLeastContrast * median(shares))) {
    throw InputError(
        fmt::format(
            "{}: no direction of plant rows stands out; give it in degrees "
            "counter-clockwise from east, or look elsewhere: in another window, or by another seed",
            field.name),
        Remedy::kRowHeading);
  }
  const int side = static_cast<int>(std::lround(kCoarseStep / kFineStep));
  const std::vector<double> near =
      explainedBy(samples, reach, coarse - kCoarseStep, kFineStep, 2 * side + 1);
  const double heading =
      coarse - kCoarseStep +
      kFineStep * static_cast<double>(std::max_element(near.begin(), near.end()) - near.begin());
  return std::remainder(heading, std::numbers::pi);
}

}  // namespace agricolmap::simulate
