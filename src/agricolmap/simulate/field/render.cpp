#include "agricolmap/simulate/field/render.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/simulate/field/leaf_painter.hpp"
#include "agricolmap/simulate/field/light.hpp"

namespace agricolmap::simulate {

namespace {

constexpr int kTileCells = 512;
using Tile = LeafPainter::Tile;

constexpr std::uint64_t kClods = 41;
constexpr std::uint64_t kTools = 51;
constexpr std::uint64_t kMoisture = 61;
constexpr std::uint64_t kFine = 71;
constexpr std::uint64_t kMarks = 81;
constexpr std::uint64_t kCover = 91;

/// The noise fields of a tile's soil. Coarse ones are the field's; fine ones are mixed from the
/// field's and the visit's so that `unshared` of their variance is the visit's own.
class SoilPainter {
 public:
  SoilPainter(const FieldModel& field, const Visit& visit, const Window& window, const Tile& tile)
      : clod_height_(static_cast<float>(field.options().clods)),
        brightness_(static_cast<float>(field.options().soil.brightness)),
        contrast_(static_cast<float>(field.options().soil.contrast * visit.soil_contrast)),
        tillage_(static_cast<float>(field.options().soil.tillage)),
        cover_(normalQuantile(field.options().soil.cover)),
        shared_(static_cast<float>(std::sqrt(1.0 - visit.soil_unshared))),
        own_(static_cast<float>(std::sqrt(visit.soil_unshared))),
        box_(boundsOf(window, tile, [](const Eigen::Vector2d& p) { return p; })),
        row_box_(boundsOf(window, tile,
                          [&](const Eigen::Vector2d& p) { return field.rowCoordinates(p); })),
        tools_(hashBits(field.seed() + kTools, 1), row_box_.low.x() / kStripeLength,
               row_box_.high.x() / kStripeLength, row_box_.low.y() / kStripeWidth,
               row_box_.high.y() / kStripeWidth),
        coarse_clods_(make(field.seed() + kClods, 0.11)),
        clods_(make(field.seed() + kClods + 1, 0.045)),
        own_clods_(make(visit.seed + kClods + 1, 0.045)),
        crumbs_(make(field.seed() + kClods + 2, 0.018)),
        own_crumbs_(make(visit.seed + kClods + 2, 0.018)),
        moisture_(make(field.seed() + kMoisture, 1.7)),
        patches_(make(field.seed() + kMoisture + 1, 0.35)),
        fine_(make(field.seed() + kFine, 0.025)),
        own_fine_(make(visit.seed + kFine, 0.025)),
        tint_(make(field.seed() + kFine + 1, 0.07)),
        own_tint_(make(visit.seed + kFine + 1, 0.07)) {
    if (tillage_ > 0.0F) {
      marks_.emplace(hashBits(field.seed() + kMarks, 1), row_box_.low.x() / kMarkLength,
                     row_box_.high.x() / kMarkLength, row_box_.low.y() / kMarkWidth,
                     row_box_.high.y() / kMarkWidth);
    }
    if (field.options().soil.cover > 0.0) {
      carpet_.emplace(make(field.seed() + kCover, 0.30));
      tufts_.emplace(make(field.seed() + kCover + 2, 0.09));
      sprigs_.emplace(make(field.seed() + kCover + 1, 0.03));
      own_sprigs_.emplace(make(visit.seed + kCover + 1, 0.03));
    }
  }

  /// `uv` are the point's coordinates along and across the rows, `smooth` is the soil's height
  /// without clods, `track` 1 in wheel tracks.
  void paint(const Eigen::Vector2d& point, const Eigen::Vector2d& uv, float smooth, float track,
             Cell& cell, float& ground) const {
    // Wheels flatten the clods, harrows leave stripes.
    const float rough = clod_height_ * (1.0F - 0.6F * track);
    const float stripes =
        tools_((1.0 / kStripeLength) * uv.x(), (1.0 / kStripeWidth) * uv.y()) * (1.0F - track);
    const float coarse = at(coarse_clods_, point, 0.11);
    const float clods = mix(clods_, own_clods_, point, 0.045);
    const float crumbs = mix(crumbs_, own_crumbs_, point, 0.018);
    const float bumps = 0.6F * coarse + 0.5F * stripes + 0.5F * clods + 0.25F * crumbs;
    ground = smooth + rough * bumps;
    cell.z = ground;
    cell.light = kBare;
    // Dry tops are lighter than the moist soil between.
    float brightness = 0.14F * at(moisture_, point, 1.7) + 0.08F * at(patches_, point, 0.35) +
                       0.07F * bumps + 0.10F * mix(fine_, own_fine_, point, 0.025) - 0.12F * track;
    if (marks_) {
      brightness += tillage_ * (*marks_)((1.0 / kMarkLength) * uv.x(), (1.0 / kMarkWidth) * uv.y());
    }
    const float tint = 0.03F * mix(tint_, own_tint_, point, 0.07);
    const float albedo = brightness_ * std::max(0.3F, 1.0F + contrast_ * brightness);
    std::array<float, 3> soil = {0.235F * albedo * (1.0F + tint), 0.185F * albedo,
                                 0.140F * albedo * (1.0F - tint)};
    if (carpet_) grow(point, soil);
    cell.albedo = {encodeAlbedo(soil[0]), encodeAlbedo(soil[1]), encodeAlbedo(soil[2])};
  }

 private:
  struct Bounds {
    Eigen::Vector2d low;
    Eigen::Vector2d high;
  };
  /// The green carpet, in patches with ragged borders.
  void grow(const Eigen::Vector2d& point, std::array<float, 3>& soil) const {
    const float sprig = mix(*sprigs_, *own_sprigs_, point, 0.03);
    const float thick =
        0.6F * at(*carpet_, point, 0.30) + 0.6F * at(*tufts_, point, 0.09) + 0.5F * sprig;
    const float covered = std::clamp(0.5F + 2.5F * (thick - cover_), 0.0F, 1.0F);
    constexpr std::array<float, 3> kGreen = {0.080F, 0.145F, 0.045F};
    for (std::size_t k = 0; k < 3; ++k) {
      soil[k] += covered * ((1.0F + 0.2F * sprig) * kGreen[k] - soil[k]);
    }
  }
  template <typename Map>
  static Bounds boundsOf(const Window& window, const Tile& tile, const Map& map) {
    Bounds box{Eigen::Vector2d::Constant(1e30), Eigen::Vector2d::Constant(-1e30)};
    for (const int c : {tile.col0, tile.col1}) {
      for (const int r : {tile.row0, tile.row1}) {
        const Eigen::Vector2d corner = map(window.field(window.cell * Eigen::Vector2d(c, r)));
        box.low = box.low.cwiseMin(corner);
        box.high = box.high.cwiseMax(corner);
      }
    }
    return box;
  }
  NoiseTile make(std::uint64_t seed, double feature) const {
    return {hashBits(seed, 1), box_.low.x() / feature, box_.high.x() / feature,
            box_.low.y() / feature, box_.high.y() / feature};
  }
  static float at(const NoiseTile& noise, const Eigen::Vector2d& point, double feature) {
    const double scale = 1.0 / feature;  // folded: `feature` is a constant at every call
    return noise(scale * point.x(), scale * point.y());
  }
  float mix(const NoiseTile& shared, const NoiseTile& own, const Eigen::Vector2d& point,
            double feature) const {
    float value = 0.0F;
    if (shared_ > 0.0F) value += shared_ * at(shared, point, feature);
    if (own_ > 0.0F) value += own_ * at(own, point, feature);
    return value;
  }

  static constexpr double kStripeLength = 1.5;  // of the harrow's marks [m]
  static constexpr double kStripeWidth = 0.07;
  static constexpr double kMarkLength = 4.0;  // of what tines and wheels leave [m]
  static constexpr double kMarkWidth = 0.05;
  float clod_height_;
  float brightness_;
  float contrast_;
  float tillage_;
  float cover_;
  float shared_;
  float own_;
  Bounds box_;
  Bounds row_box_;
  NoiseTile tools_;
  NoiseTile coarse_clods_;
  NoiseTile clods_;
  NoiseTile own_clods_;
  NoiseTile crumbs_;
  NoiseTile own_crumbs_;
  NoiseTile moisture_;
  NoiseTile patches_;
  NoiseTile fine_;
  NoiseTile own_fine_;
  NoiseTile tint_;
  NoiseTile own_tint_;
  std::optional<NoiseTile> marks_;
  std::optional<NoiseTile> carpet_;
  std::optional<NoiseTile> tufts_;
  std::optional<NoiseTile> sprigs_;
  std::optional<NoiseTile> own_sprigs_;
};

/// What varies slowly, on every fourth cell: ridges and tracks are wider.
struct SmoothSoil {
  static constexpr int kStep = 4;
  Raster<float> height;
  Raster<float> track;
};

SmoothSoil smoothSoil(const FieldModel& field, const Window& window) {
  constexpr int kStep = SmoothSoil::kStep;
  SmoothSoil soil;
  soil.height = Raster<float>(window.rows / kStep + 2, window.cols / kStep + 2);
  soil.track = soil.height;
  parallelFor(
      static_cast<std::size_t>(soil.height.rows()),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < soil.height.cols(); ++c) {
          const Eigen::Vector2d point =
              window.field(window.cell * Eigen::Vector2d(kStep * c + 0.5, kStep * r + 0.5));
          soil.height(r, c) = static_cast<float>(field.soilHeight(point));
          soil.track(r, c) = field.wheelTrack(field.rowCoordinates(point).y());
        }
      },
      16);
  return soil;
}

void paintSoil(const FieldModel& field, const Visit& visit, const SmoothSoil& smooth,
               const Tile& tile, Canvas& canvas) {
  const Window& window = canvas.window;
  const SoilPainter painter(field, visit, window, tile);
  constexpr float kToSmooth = 1.0F / SmoothSoil::kStep;
  for (int r = tile.row0; r < tile.row1; ++r) {
    // Both frames are linear in the column.
    Eigen::Vector2d point = window.field(window.cell * Eigen::Vector2d(tile.col0 + 0.5, r + 0.5));
    const Eigen::Vector2d next =
        window.field(window.cell * Eigen::Vector2d(tile.col0 + 1.5, r + 0.5));
    Eigen::Vector2d uv = field.rowCoordinates(point);
    const Eigen::Vector2d point_step = next - point;
    const Eigen::Vector2d uv_step = field.rowCoordinates(next) - uv;
    Cell* cells = canvas.cells.row(r);
    float* ground = canvas.ground.row(r);
    const float smooth_row = kToSmooth * static_cast<float>(r);
    for (int c = tile.col0; c < tile.col1; ++c, point += point_step, uv += uv_step) {
      const float smooth_col = kToSmooth * static_cast<float>(c);
      painter.paint(point, uv, sampleRaster(smooth.height, smooth_col, smooth_row),
                    sampleRaster(smooth.track, smooth_col, smooth_row), cells[c], ground[c]);
    }
  }
}

std::vector<Tile> tilesOf(const Window& window) {
  std::vector<Tile> tiles;
  for (int r = 0; r < window.rows; r += kTileCells) {
    for (int c = 0; c < window.cols; c += kTileCells) {
      tiles.push_back(
          {r, std::min(window.rows, r + kTileCells), c, std::min(window.cols, c + kTileCells)});
    }
  }
  return tiles;
}

/// Indices of the plants that may reach into each tile, in order.
std::vector<std::vector<std::uint32_t>> plantsPerTile(const std::vector<Plant>& plants,
                                                      const std::vector<Tile>& tiles,
                                                      const Window& window, double farther) {
  std::vector<std::vector<std::uint32_t>> lists(tiles.size());
  const int tile_cols = (window.cols + kTileCells - 1) / kTileCells;
  const int tile_rows = (window.rows + kTileCells - 1) / kTileCells;
  const auto firstOf = [](double from) {
    return std::max(0, static_cast<int>(std::ceil(from / kTileCells)) - 1);
  };
  const auto lastOf = [](double to, int count) {
    return std::min(count - 1, static_cast<int>(std::floor(to / kTileCells)));
  };
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const Plant& plant = plants[i];
    const Eigen::Vector2d at = window.local(plant.position.cast<double>()) / window.cell;
    const double reach = 0.03 / window.cell + reachOf(plant.species) *
                                                  static_cast<double>(plant.size) * farther /
                                                  window.cell;
    const int last_row = lastOf(at.y() + reach, tile_rows);
    const int last_col = lastOf(at.x() + reach, tile_cols);
    for (int row = firstOf(at.y() - reach); row <= last_row; ++row) {
      for (int col = firstOf(at.x() - reach); col <= last_col; ++col) {
        const auto k = static_cast<std::size_t>(row * tile_cols + col);
        if (at.x() - reach <= tiles[k].col1 && at.y() - reach <= tiles[k].row1) {
          lists[k].push_back(static_cast<std::uint32_t>(i));
        }
      }
    }
  }
  return lists;
}

}  // namespace

bool goneFor(const Visit& visit, const Plant& plant) {
  const auto drawn = [&](std::int64_t why, double share) {
    return hashUniform(plant.id, 1, why) < static_cast<float>(share);
  };
  if (isWeed(plant.species)) return drawn(2, visit.weeds_pulled) || drawn(3, visit.weeds_new);
  return grows(plant.species) && drawn(4, visit.plants_lost);
}

Canvas renderVisit(const FieldModel& field, const Visit& visit, const Window& window) {
  Canvas canvas;
  canvas.window = window;
  canvas.cells = Raster<Cell>(window.rows, window.cols);
  canvas.ground = Raster<float>(window.rows, window.cols);
  std::vector<Plant> plants = field.plantsIn(window, visit.reach());
  std::erase_if(plants, [&](const Plant& plant) { return goneFor(visit, plant); });
  const SmoothSoil smooth = smoothSoil(field, window);
  const std::vector<Tile> tiles = tilesOf(window);
  const std::vector<std::vector<std::uint32_t>> lists =
      plantsPerTile(plants, tiles, window, visit.reach());
  const Eigen::Vector3d sun = sunDirection(visit.solar_hour);
  const Eigen::Vector2d flat = Eigen::Rotation2Dd(-window.heading) * sun.head<2>();
  const Eigen::Vector3f sun_in_window(static_cast<float>(flat.x()), static_cast<float>(flat.y()),
                                      static_cast<float>(sun.z()));
  parallelFor(tiles.size(), [&](std::size_t k) {
    paintSoil(field, visit, smooth, tiles[k], canvas);
    LeafPainter painter(canvas, tiles[k], sun_in_window);
    for (const std::uint32_t i : lists[k]) {
      const Plant& plant = plants[i];
      const auto soil = static_cast<float>(field.soilHeight(plant.position.cast<double>()));
      painter.paint(plant, growFoliage(plant, visit), soil);
    }
  });
  canvas.leaf_depth = leafDepthOf(field.species());
  lightCanvas(canvas, sun, visit.overcast);
  return canvas;
}

}  // namespace agricolmap::simulate
