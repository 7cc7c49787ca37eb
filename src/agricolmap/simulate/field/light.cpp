#include "agricolmap/simulate/field/light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::simulate {

Eigen::Vector3d sunDirection(double solar_hour) {
  const double latitude = radians(46.0);
  const double declination = radians(22.0);
  const double hour_angle = radians((solar_hour - 12.0) * 15.0);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  // Never below 8 degrees: long shadows, but still a day.
  Eigen::Vector3d sun(east, north, std::max(up, std::sin(radians(8.0))));
  return sun.normalized();
}

namespace {

/// Cosine of sun and soil from the slope of the cells.
void lightSoil(Canvas& canvas, const Eigen::Vector3f& sun) {
  const int rows = canvas.cells.rows();
  const int cols = canvas.cells.cols();
  const float scale = static_cast<float>(0.5 / canvas.window.cell);
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        Cell* row = canvas.cells.row(r);
        const float* below = canvas.ground.row(std::max(0, r - 1));
        const float* here = canvas.ground.row(r);
        const float* above = canvas.ground.row(std::min(rows - 1, r + 1));
        for (int c = 0; c < cols; ++c) {
          if (row[c].light != kBare) continue;
          const float dx = scale * (here[std::min(cols - 1, c + 1)] - here[std::max(0, c - 1)]);
          const float dy = scale * (above[c] - below[c]);
          const float cosine =
              (sun.z() - dx * sun.x() - dy * sun.y()) / std::sqrt(1.0F + dx * dx + dy * dy);
          row[c].light = static_cast<std::uint8_t>(255.0F * std::clamp(cosine, 0.0F, 1.0F));
        }
      },
      16);
}

/// Darkens a cell that lies below the shadow's upper edge; a soft edge of 2 cm.
void shade(Cell& cell, float edge) {
  const float depth = edge - cell.z;
  if (depth <= 0.0F) return;
  const float lit = std::max(0.0F, 1.0F - depth * 50.0F);
  cell.light = static_cast<std::uint8_t>(static_cast<float>(cell.light) * lit);
}

/// Walks away from the sun row by row, carrying the height up to which the shadow of what was
/// passed reaches. `to_sun` is horizontal, in cells of the canvas; |y| dominates.
void castAlongRows(Canvas& canvas, const Eigen::Vector2f& to_sun, float tangent) {
  const int rows = canvas.cells.rows();
  const int cols = canvas.cells.cols();
  const float shift = to_sun.x() / std::abs(to_sun.y());
  const float drop = static_cast<float>(canvas.window.cell) * tangent * std::hypot(1.0F, shift);
  const int other = shift >= 0.0F ? 1 : -1;
  const float weight = std::abs(shift);
  std::vector<float> edge(static_cast<std::size_t>(cols), -1e9F);
  std::vector<float> next(static_cast<std::size_t>(cols));
  for (int k = 0; k < rows; ++k) {
    Cell* row = canvas.cells.row(to_sun.y() > 0.0F ? rows - 1 - k : k);
    for (int c = 0; c < cols; ++c) {
      const int d = std::clamp(c + other, 0, cols - 1);
      next[static_cast<std::size_t>(c)] = (1.0F - weight) * edge[static_cast<std::size_t>(c)] +
                                          weight * edge[static_cast<std::size_t>(d)] - drop;
    }
    for (int c = 0; c < cols; ++c) {
      shade(row[c], next[static_cast<std::size_t>(c)]);
      edge[static_cast<std::size_t>(c)] = std::max(next[static_cast<std::size_t>(c)], row[c].z);
    }
  }
}

/// The same where |x| dominates: a cell depends on its neighbour towards the sun in this row and in
/// the next row towards the sun, which is done already.
void castAlongColumns(Canvas& canvas, const Eigen::Vector2f& to_sun, float tangent) {
  const int rows = canvas.cells.rows();
  const int cols = canvas.cells.cols();
  const float weight = std::abs(to_sun.y() / to_sun.x());
  const float drop = static_cast<float>(canvas.window.cell) * tangent * std::hypot(1.0F, weight);
  const bool from_right = to_sun.x() > 0.0F;
  std::vector<float> previous(static_cast<std::size_t>(cols) + 1, -1e9F);
  std::vector<float> edge(previous);
  for (int k = 0; k < rows; ++k) {
    Cell* row = canvas.cells.row(to_sun.y() > 0.0F ? rows - 1 - k : k);
    for (int i = 0; i < cols; ++i) {
      const std::size_t at = static_cast<std::size_t>(i) + 1;
      const float next = (1.0F - weight) * edge[at - 1] + weight * previous[at - 1] - drop;
      Cell& cell = row[from_right ? cols - 1 - i : i];
      shade(cell, next);
      edge[at] = std::max(next, cell.z);
    }
    std::swap(previous, edge);
    edge[0] = -1e9F;
  }
}

/// Share of the sky a cell sees, from how deep it lies below its surroundings.
void fillSky(Canvas& canvas) {
  constexpr int kStep = Canvas::kSkyStep;
  const int rows = (canvas.cells.rows() + kStep - 1) / kStep;
  const int cols = (canvas.cells.cols() + kStep - 1) / kStep;
  canvas.sky = Raster<float>(rows, cols);
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < cols; ++c) {
          float sum = 0.0F;
          int count = 0;
          for (int y = r * kStep; y < std::min((r + 1) * kStep, canvas.cells.rows()); ++y) {
            for (int x = c * kStep; x < std::min((c + 1) * kStep, canvas.cells.cols()); ++x) {
              sum += canvas.cells(y, x).z;
              ++count;
            }
          }
          canvas.sky(r, c) = sum / static_cast<float>(count);
        }
      },
      16);
  const double large = canvas.window.cell * kStep;
  Raster<float> around = canvas.sky;
  blurRaster(around, 0.10 / large);
  for (std::size_t i = 0; i < around.size(); ++i) {
    const float depth = around[i] - canvas.sky[i];
    canvas.sky[i] = std::clamp(1.0F - 6.0F * depth, 0.3F, 1.15F);
  }
}

}  // namespace

void lightCanvas(Canvas& canvas, const Eigen::Vector3d& sun, double overcast) {
  const Eigen::Vector2d flat = Eigen::Rotation2Dd(-canvas.window.heading) * sun.head<2>();
  const Eigen::Vector3f local(static_cast<float>(flat.x()), static_cast<float>(flat.y()),
                              static_cast<float>(sun.z()));
  canvas.sky_share = static_cast<float>(overcast);
  canvas.sun_share = static_cast<float>(1.0 - overcast);
  lightSoil(canvas, local);
  const float tangent = local.z() / local.head<2>().norm();
  if (std::abs(local.y()) >= std::abs(local.x())) {
    castAlongRows(canvas, local.head<2>(), tangent);
  } else {
    castAlongColumns(canvas, local.head<2>(), tangent);
  }
  fillSky(canvas);
}

}  // namespace agricolmap::simulate
