// What the tests of simulated pairs share: small pairs, and how alike their two views are.
#pragma once

#include <algorithm>
#include <cmath>

#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/simulate/field/canvas.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::simulate {

/// A field small enough for tests.
inline SimulationOptions smallOptions(Crop crop = Crop::kSugarBeet10m) {
  SimulationOptions options = cropPreset(crop);
  options.field.width = 6.0;
  options.field.height = 6.0;
  options.ugv.length = 5.0;
  options.ugv.width = 1.6;
  options.ugv.spacing = 0.006;
  options.seed = 7;
  return options;
}

inline double rms(const SimulatedPair& pair, const Eigen::Affine3d& affine) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pair.truth.size(); ++i) {
    sum += (affine * pair.ugv.filePoint(i) - pair.truth[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(pair.truth.size()));
}

/// Mean chromatic ExG, brightness and height on 2 cm cells of the strip, in the strip's own axes.
struct StripMap {
  static constexpr double kCell = 0.02;
  StripMap(const SimulatedPair& pair, const SimulationOptions& options)
      : rows(static_cast<int>(options.ugv.width / kCell)),
        cols(static_cast<int>(options.ugv.length / kCell)),
        from(Eigen::Translation3d(0.5 * options.ugv.length, 0.5 * options.ugv.width, 0.0) *
             Eigen::AngleAxisd(-pair.strip_heading, Eigen::Vector3d::UnitZ()) *
             Eigen::Translation3d(-pair.strip_centre)),
        count(rows, cols),
        exg(rows, cols),
        grey(rows, cols),
        height(rows, cols) {}
  void add(const Eigen::Vector3d& point, Rgb rgb) {
    const Eigen::Vector3d p = from * point / kCell;
    const int c = static_cast<int>(std::floor(p.x()));
    const int r = static_cast<int>(std::floor(p.y()));
    if (!count.contains(r, c)) return;
    const float green = map::excessGreen(rgb, map::ExgKind::kChromatic);
    count(r, c) += 1.0F;
    exg(r, c) += (green - exg(r, c)) / count(r, c);
    grey(r, c) += (static_cast<float>(rgb.r + rgb.g + rgb.b) / 3.0F - grey(r, c)) / count(r, c);
    height(r, c) += (static_cast<float>(p.z() * kCell) - height(r, c)) / count(r, c);
  }
  int rows;
  int cols;
  Eigen::Affine3d from;
  Raster<float> count;
  Raster<float> exg;
  Raster<float> grey;
  Raster<float> height;
};

inline StripMap mapFromAbove(const SimulatedPair& pair, const SimulationOptions& options) {
  StripMap map(pair, options);
  for (std::size_t i = 0; i < pair.uav.size(); ++i) map.add(pair.uav.filePoint(i), pair.uav.rgb[i]);
  return map;
}
inline StripMap mapFromGround(const SimulatedPair& pair, const SimulationOptions& options) {
  StripMap map(pair, options);
  for (std::size_t i = 0; i < pair.truth.size(); ++i) map.add(pair.truth[i], pair.ugv.rgb[i]);
  return map;
}

/// Correlation of the two views' ExG, or another layer, over the cells that both fill, coarse part
/// removed.
inline double correlation(const SimulatedPair& pair, const SimulationOptions& options,
                          Raster<float> StripMap::*layer = &StripMap::exg) {
  const StripMap a = mapFromAbove(pair, options);
  const StripMap b = mapFromGround(pair, options);
  const auto highPassed = [&](const StripMap& map) {
    Raster<float> low = map.*layer;
    Raster<float> weight = map.count;
    for (float& w : weight) w = w > 0.0F ? 1.0F : 0.0F;
    blurRaster(low, 0.25 / StripMap::kCell);
    blurRaster(weight, 0.25 / StripMap::kCell);
    Raster<float> high = map.*layer;
    for (std::size_t i = 0; i < high.size(); ++i) high[i] -= low[i] / std::max(weight[i], 1e-3F);
    return high;
  };
  const Raster<float> x = highPassed(a);
  const Raster<float> y = highPassed(b);
  double n = 0.0;
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double syy = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (a.count[i] == 0.0F || b.count[i] == 0.0F) continue;
    const double u = static_cast<double>(x[i]);
    const double v = static_cast<double>(y[i]);
    n += 1.0;
    sx += u;
    sy += v;
    sxx += u * u;
    syy += v * v;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / std::sqrt((n * sxx - sx * sx) * (n * syy - sy * sy));
}

inline double correlation(const SimulationOptions& options,
                          Raster<float> StripMap::*layer = &StripMap::exg) {
  return correlation(simulatePair(options), options, layer);
}

/// Share of a cloud's points that are green.
inline double greenShare(const Cloud& cloud) {
  const auto green = std::count_if(cloud.rgb.begin(), cloud.rgb.end(),
                                   [](Rgb c) { return 2 * c.g - c.r - c.b > 25; });
  return static_cast<double>(green) / static_cast<double>(cloud.size());
}

}  // namespace agricolmap::simulate
