// What one visit to the field finds, seen from straight above: a raster of heights, reflectances
// and light in a window of the field that may lie at any angle.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::simulate {

/// A rectangle of the field with its raster: x runs along `heading`, rows run to its left.
struct Window {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< of cell (0, 0), field frame [m]
  double heading = 0.0;                              ///< [rad]
  double cell = 0.01;                                ///< [m]
  int rows = 0;
  int cols = 0;

  double width() const { return cell * cols; }
  double height() const { return cell * rows; }
  /// Field coordinates of a point given in metres from the corner along the window's axes.
  Eigen::Vector2d field(const Eigen::Vector2d& local) const {
    return corner + Eigen::Rotation2Dd(heading) * local;
  }
  /// The inverse of field().
  Eigen::Vector2d local(const Eigen::Vector2d& point) const {
    return Eigen::Rotation2Dd(-heading) * (point - corner);
  }
};

/// A window of the given size [m], corner and heading.
Window makeWindow(const Eigen::Vector2d& corner, double heading, double width, double height,
                  double cell);

/// The surface in one cell.
struct Cell {
  float z = 0.0F;                        ///< top of plant or soil [m]
  std::array<std::uint8_t, 3> albedo{};  ///< reflectance, 255·√ρ
  std::uint8_t light = 0;                ///< sunlight, see lightCanvas; kBare before that: soil
};

/// Mark of a soil cell before lighting; leaves store 1…255 = 255 × cosine of sun and leaf.
inline constexpr std::uint8_t kBare = 0;

inline std::uint8_t encodeAlbedo(float reflectance) {
  const float v = 255.0F * std::sqrt(std::min(1.0F, std::max(0.0F, reflectance)));
  return static_cast<std::uint8_t>(v + 0.5F);
}
inline float decodeAlbedo(std::uint8_t value) {
  const float v = static_cast<float>(value) * (1.0F / 255.0F);
  return v * v;
}

struct Canvas {
  Window window;
  Raster<Cell> cells;
  Raster<float> ground;          ///< height of the soil, with clods [m]
  Raster<std::uint8_t> present;  ///< 0 where nothing is known; empty: known everywhere
  Raster<float> sky;             ///< share of the sky seen, on cells four times as large
  float leaf_depth = 0.1F;  ///< below this depth under a leaf one can look through the plant [m]
  float sun_share = 0.0F;   ///< sunlight of a surface that faces the sun, total light is 1
  float sky_share = 1.0F;   ///< light of the open sky

  bool isPresent(int row, int col) const { return present.empty() || present(row, col) != 0; }
  /// Light reflected by a cell towards the camera, per channel, linear.
  std::array<float, 3> radiance(int row, int col) const {
    const Cell& c = cells(row, col);
    const int sky_row = std::min(row / kSkyStep, sky.rows() - 1);
    const int sky_col = std::min(col / kSkyStep, sky.cols() - 1);
    const float sun = sun_share * static_cast<float>(c.light) * (1.0F / 255.0F);
    const float blue = sky_share * sky(sky_row, sky_col);
    // Sunlight is warmer than the sky's.
    return {decodeAlbedo(c.albedo[0]) * (1.04F * sun + 0.88F * blue),
            decodeAlbedo(c.albedo[1]) * (sun + blue),
            decodeAlbedo(c.albedo[2]) * (0.94F * sun + 1.20F * blue)};
  }

  static constexpr int kSkyStep = 4;
};

/// Separable Gaussian blur with clamped borders; deviation in cells, none below 0.2.
void blurRaster(Raster<float>& raster, double sigma);

/// Bilinear value at continuous cell coordinates (0 = centre of cell 0), clamped at the borders.
float sampleRaster(const Raster<float>& raster, float col, float row);

}  // namespace agricolmap::simulate
