#include "agricolmap/simulate/ortho/ortho_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/field_model.hpp"

namespace agricolmap::simulate {

namespace {

constexpr double kLeafScale = 0.05;    // texture below this is a view's own [m]
constexpr double kPlantHeight = 0.15;  // of made-up plants of size 1 [m]
constexpr double kSwapPatch = 0.25;    // side of patches of replaced texture [m]

void checkField(const OrthoField& field) {
  const auto fits = [&](const auto& raster) {
    return raster.empty() ||
           (raster.rows() == field.colour.rows() && raster.cols() == field.colour.cols());
  };
  if (field.colour.empty() || !(field.gsd > 0.0)) {
    throw InputError(fmt::format("{}: no colours or no ground sampling distance", field.name));
  }
  if (!fits(field.valid) || !fits(field.height) || !fits(field.ground)) {
    throw InputError(fmt::format(
        "{}: heights, ground or mask differ in size from the colours ({} x {}); resample them",
        field.name, field.colour.cols(), field.colour.rows()));
  }
  if (!field.valid.empty() && std::all_of(field.valid.begin(), field.valid.end(),
                                          [](std::uint8_t valid) { return valid == 0; })) {
    throw InputError(fmt::format("{}: none of its pixels has data", field.name));
  }
}

/// Share of plant in a colour, from its chromatic Excess Green.
float plantShare(const std::array<float, 3>& rgb) {
  const float sum = rgb[0] + rgb[1] + rgb[2];
  if (sum <= 1.0F) return 0.0F;
  return std::clamp(((3.0F * rgb[1] - sum) / sum - 0.03F) / 0.15F, 0.0F, 1.0F);
}

}  // namespace

OrthoScene::OrthoScene(const OrthoField& field, const SimulationOptions& options,
                       std::uint64_t seed)
    : field_(&field), options_(options), seed_(seed) {
  checkField(field);
  const int rows = field.colour.rows();
  const int cols = field.colour.cols();
  for (Raster<float>& channel : coarse_) channel = Raster<float>(rows, cols);
  strength_ = Raster<float>(rows, cols);
  canopy_ = Raster<float>(rows, cols);
  ground_ = Raster<float>(rows, cols);
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      const Rgb rgb = field.colour(r, c);
      coarse_[0](r, c) = rgb.r;
      coarse_[1](r, c) = rgb.g;
      coarse_[2](r, c) = rgb.b;
    }
  });
  for (Raster<float>& channel : coarse_) blurRaster(channel, kLeafScale / field.gsd);
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      const float fine = static_cast<float>(field.colour(r, c).g) - coarse_[1](r, c);
      strength_(r, c) = fine * fine;
    }
  });
  blurRaster(strength_, 1.5 * kLeafScale / field.gsd);
  for (float& s : strength_) s = std::sqrt(s) + 1.0F;
  if (field.height.empty()) {
    makeUpHeights();
  } else {
    splitHeights();
  }
}

void OrthoScene::makeUpHeights() {
  FieldOptions soil = options_.field;
  soil.random_row_heading = false;
  soil.row_heading_deg = degrees(field_->row_heading);
  soil.ridge = 0.0;  // where the real rows lie is not known to the simulated soil
  soil.tramline_spacing = 0.0;
  soil.width = std::clamp(width(), 2.0, 200.0);
  soil.height = std::clamp(height(), 2.0, 200.0);
  const FieldModel model(options_.crop, soil, seed_);
  const int cols = field_->colour.cols();
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      const Eigen::Vector2d point = field_->gsd * Eigen::Vector2d(c + 0.5, r + 0.5);
      ground_(r, c) = static_cast<float>(model.soilHeight(point)) +
                      static_cast<float>(0.7 * soil.clods) *
                          noiseAt(seed_ + 1, point.x() / 0.09, point.y() / 0.09);
      const Rgb rgb = field_->colour(r, c);
      canopy_(r, c) = plantShare(
          {static_cast<float>(rgb.r), static_cast<float>(rgb.g), static_cast<float>(rgb.b)});
    }
  });
  // Plants rise from their edges to their middles.
  blurRaster(canopy_, 0.02 / field_->gsd);
  const auto full = static_cast<float>(kPlantHeight * soil.plant_size);
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      const Eigen::Vector2d point = field_->gsd * Eigen::Vector2d(c + 0.5, r + 0.5);
      const float plant = 1.0F + 0.25F * noiseAt(seed_ + 2, point.x() / 0.2, point.y() / 0.2);
      canopy_(r, c) = full * std::max(0.2F, plant) * std::sqrt(canopy_(r, c)) *
                      std::min(1.0F, 4.0F * canopy_(r, c));
    }
  });
}

void OrthoScene::splitHeights() {
  const int rows = field_->colour.rows();
  const int cols = field_->colour.cols();
  if (!field_->ground.empty()) {
    ground_ = field_->ground;
  } else {
    // The lowest surface within half a metre, by rows and then by columns, smoothed.
    const int reach = std::max(1, static_cast<int>(0.5 / field_->gsd));
    Raster<float> by_rows(rows, cols);
    forRows([&](int r) {
      for (int c = 0; c < cols; ++c) {
        const float* row = field_->height.row(r);
        by_rows(r, c) =
            *std::min_element(row + std::max(0, c - reach), row + std::min(cols, c + reach + 1));
      }
    });
    forRows([&](int r) {
      for (int c = 0; c < cols; ++c) {
        float lowest = by_rows(r, c);
        for (int k = std::max(0, r - reach); k <= std::min(rows - 1, r + reach); ++k) {
          lowest = std::min(lowest, by_rows(k, c));
        }
        ground_(r, c) = lowest;
      }
    });
    blurRaster(ground_, 0.25 / field_->gsd);
  }
  // Absolute heights belong to the geotag.
  const float zero = ground_(rows / 2, cols / 2);
  zero_ = static_cast<double>(zero);
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      canopy_(r, c) = field_->height(r, c) - ground_(r, c);
      ground_(r, c) -= zero;
    }
  });
}

std::array<float, 3> OrthoScene::fineAt(const Eigen::Vector2f& at) const {
  const int cols = field_->colour.cols();
  const int rows = field_->colour.rows();
  const float x = std::clamp(at.x(), 0.0F, static_cast<float>(cols) - 1.001F);
  const float y = std::clamp(at.y(), 0.0F, static_cast<float>(rows) - 1.001F);
  const int c = std::min(static_cast<int>(x), std::max(0, cols - 2));
  const int r = std::min(static_cast<int>(y), std::max(0, rows - 2));
  const float fx = x - static_cast<float>(c);
  const float fy = y - static_cast<float>(r);
  std::array<float, 3> sum{};
  for (const int dr : {0, 1}) {
    for (const int dc : {0, 1}) {
      const float weight = (dr == 1 ? fy : 1.0F - fy) * (dc == 1 ? fx : 1.0F - fx);
      const int rr = std::min(r + dr, rows - 1);
      const int cc = std::min(c + dc, cols - 1);
      const Rgb rgb = field_->colour(rr, cc);
      sum[0] += weight * (static_cast<float>(rgb.r) - coarse_[0](rr, cc));
      sum[1] += weight * (static_cast<float>(rgb.g) - coarse_[1](rr, cc));
      sum[2] += weight * (static_cast<float>(rgb.b) - coarse_[2](rr, cc));
    }
  }
  return sum;
}

Eigen::Vector2f OrthoScene::swapShift(const Eigen::Vector2d& point, const Visit& visit) const {
  // Each patch takes its texture from another direction, so that no common shift fits the swapped
  // texture; frayed borders hide the seams.
  const double fray =
      0.2 * static_cast<double>(noiseAt(visit.seed + 5, point.x() / 0.05, point.y() / 0.05));
  const auto i = static_cast<std::int64_t>(std::floor(point.x() / kSwapPatch + fray));
  const auto j = static_cast<std::int64_t>(std::floor(point.y() / kSwapPatch + fray));
  const float angle = 6.2831853F * hashUniform(visit.seed + 6, i, j);
  const float distance = 0.10F + 0.15F * hashUniform(visit.seed + 7, i, j);
  return distance / static_cast<float>(field_->gsd) *
         Eigen::Vector2f(std::cos(angle), std::sin(angle));
}

void OrthoScene::drawCell(const Eigen::Vector2d& point, const Visit& visit, float own, bool mirror,
                          Cell& cell, float& ground) const {
  const auto noise = [&](std::uint64_t k, double feature) {
    return static_cast<double>(noiseAt(visit.seed + k, point.x() / feature, point.y() / feature));
  };
  const Eigen::Vector2d still = mosaic(point, mirror);
  Eigen::Vector2f at = pixel(still);
  ground = sampleRaster(ground_, at.x(), at.y());
  const float plant = std::max(0.0F, sampleRaster(canopy_, at.x(), at.y()));
  const float sway = std::min(1.0F, plant / 0.08F);
  if ((visit.wind > 0.0 || !visit.lean.isZero()) && sway > 0.0F) {
    const double reach = visit.wind * static_cast<double>(sway);
    const Eigen::Vector2d leant = still - static_cast<double>(plant) * visit.lean;
    at = pixel(leant + reach * Eigen::Vector2d(noise(1, 0.18), noise(2, 0.18)));
  }
  const std::array<float, 3> fine = fineAt(at);
  std::array<float, 3> other{};
  float scale = 0.0F;
  if (own > 0.0F) {
    const Eigen::Vector2f there = at + swapShift(point, visit);
    other = fineAt(there);
    scale = sampleRaster(strength_, at.x(), at.y()) / sampleRaster(strength_, there.x(), there.y());
  }
  // Weights that keep the variance and leave a correlation of 1 − own.
  const float kept = 1.0F - own;
  const float drawn = std::sqrt(1.0F - kept * kept) * scale;
  float change = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    const float texture = kept * fine[k] + drawn * other[k];
    change += texture - fine[k];
    const float value = sampleRaster(coarse_[k], at.x(), at.y()) + texture;
    cell.albedo[k] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
  }
  // Leaves drawn anew are at other heights too: brighter ones are higher.
  const float canopy = sampleRaster(canopy_, at.x(), at.y());
  const float lifted = canopy * (1.0F + std::clamp(change / 250.0F, -0.3F, 0.3F));
  cell.z = ground + static_cast<float>(visit.growth) * lifted;
  cell.light = 255;
}

Canvas OrthoScene::draw(const Window& window, const Visit& visit, double own, bool mirror) const {
  Canvas canvas;
  canvas.window = window;
  canvas.cells = Raster<Cell>(window.rows, window.cols);
  canvas.ground = Raster<float>(window.rows, window.cols);
  canvas.present = Raster<std::uint8_t>(window.rows, window.cols);
  canvas.leaf_depth = leafDepthOf(speciesOf(options_.crop));
  parallelFor(
      static_cast<std::size_t>(window.rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < window.cols; ++c) {
          const Eigen::Vector2d point =
              window.field(window.cell * Eigen::Vector2d(c + 0.5, r + 0.5));
          drawCell(point, visit, static_cast<float>(own), mirror, canvas.cells(r, c),
                   canvas.ground(r, c));
          canvas.present(r, c) = valid(point, mirror) ? 1 : 0;
        }
      },
      8);
  return canvas;
}

}  // namespace agricolmap::simulate
