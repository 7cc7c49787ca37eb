#include "agricolmap/simulate/ortho.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/assemble.hpp"
#include "agricolmap/simulate/light.hpp"

namespace agricolmap {

namespace {

constexpr double kLeafScale = 0.05;    // texture below this is a view's own [m]
constexpr double kPlantHeight = 0.15;  // of made-up plants of size 1 [m]
constexpr double kSwapPatch = 0.25;    // side of patches of replaced texture [m]

std::uint64_t seedOf(const SimulationOptions& options, std::uint64_t purpose) {
  return hashBits(hashBits(0x0E70, static_cast<std::uint64_t>(options.seed)), purpose);
}

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
}

/// Share of plant in a colour, from its chromatic Excess Green.
float plantShare(const std::array<float, 3>& rgb) {
  const float sum = rgb[0] + rgb[1] + rgb[2];
  if (sum <= 1.0F) return 0.0F;
  return std::clamp(((3.0F * rgb[1] - sum) / sum - 0.03F) / 0.15F, 0.0F, 1.0F);
}

/// The mosaic taken apart: colours coarser than leaves, the strength of the rest, heights.
class OrthoScene {
 public:
  OrthoScene(const OrthoField& field, const SimulationOptions& options)
      : field_(&field), options_(&options), mirror_(false) {
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

  double width() const { return field_->gsd * field_->colour.cols(); }
  double height() const { return field_->gsd * field_->colour.rows(); }
  /// What heights of the scene are counted from [m].
  double zero() const { return zero_; }

  bool valid(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d at = mosaic(point) / field_->gsd;
    if (at.x() < 0.0 || at.y() < 0.0) return false;
    const int c = static_cast<int>(at.x());
    const int r = static_cast<int>(at.y());
    if (!field_->colour.contains(r, c)) return false;
    return field_->valid.empty() || field_->valid(r, c) != 0;
  }
  /// Looks at the mosaic mirrored end to end along its rows from now on: the same rows, other
  /// plants.
  void mirror() { mirror_ = true; }

  /// Draws the scene as a visit finds it. `own` is the share of fine texture that is the visit's
  /// own.
  Canvas draw(const Window& window, const Visit& visit, double own) const;

 private:
  template <typename Body>
  void forRows(const Body& body) {
    parallelFor(
        static_cast<std::size_t>(field_->colour.rows()),
        [&](std::size_t r) { body(static_cast<int>(r)); }, 16);
  }
  void makeUpHeights();
  void splitHeights();
  void drawCell(const Eigen::Vector2d& point, const Visit& visit, float own, Cell& cell,
                float& ground) const;
  std::array<float, 3> fineAt(const Eigen::Vector2f& at) const;
  Eigen::Vector2f swapShift(const Eigen::Vector2d& point, const Visit& visit) const;

  /// Place in the mosaic of a place in the field [m].
  Eigen::Vector2d mosaic(const Eigen::Vector2d& point) const {
    if (!mirror_) return point;
    const Eigen::Vector2d middle(0.5 * width(), 0.5 * height());
    const Eigen::Vector2d row(std::cos(field_->row_heading), std::sin(field_->row_heading));
    const Eigen::Vector2d from = point - middle;
    return middle + from - 2.0 * row.dot(from) * row;
  }
  Eigen::Vector2f pixel(const Eigen::Vector2d& place) const {
    return (place / field_->gsd).cast<float>() - Eigen::Vector2f::Constant(0.5F);
  }

  const OrthoField* field_;
  const SimulationOptions* options_;
  bool mirror_;
  std::array<Raster<float>, 3> coarse_;
  Raster<float> strength_;  ///< deviation of the texture finer than leaves, counts
  Raster<float> canopy_;    ///< above ground [m]
  Raster<float> ground_;    ///< [m]
  double zero_ = 0.0;
};

void OrthoScene::makeUpHeights() {
  FieldOptions soil = options_->field;
  soil.random_row_heading = false;
  soil.row_heading_deg = field_->row_heading * 57.29577951308232;
  soil.ridge = 0.0;  // where the real rows lie is not known to the simulated soil
  soil.tramline_spacing = 0.0;
  soil.width = std::clamp(width(), 2.0, 200.0);
  soil.height = std::clamp(height(), 2.0, 200.0);
  const std::uint64_t seed = seedOf(*options_, 11);
  const FieldModel model(options_->crop, soil, seed);
  const int cols = field_->colour.cols();
  forRows([&](int r) {
    for (int c = 0; c < cols; ++c) {
      const Eigen::Vector2d point = field_->gsd * Eigen::Vector2d(c + 0.5, r + 0.5);
      ground_(r, c) = static_cast<float>(model.soilHeight(point)) +
                      static_cast<float>(0.7 * soil.clods) *
                          noiseAt(seed + 1, point.x() / 0.09, point.y() / 0.09);
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
      const float plant = 1.0F + 0.25F * noiseAt(seed + 2, point.x() / 0.2, point.y() / 0.2);
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

void OrthoScene::drawCell(const Eigen::Vector2d& point, const Visit& visit, float own, Cell& cell,
                          float& ground) const {
  const auto noise = [&](std::uint64_t k, double feature) {
    return static_cast<double>(noiseAt(visit.seed + k, point.x() / feature, point.y() / feature));
  };
  const Eigen::Vector2d still = mosaic(point);
  Eigen::Vector2f at = pixel(still);
  ground = sampleRaster(ground_, at.x(), at.y());
  const float sway = std::clamp(sampleRaster(canopy_, at.x(), at.y()) / 0.08F, 0.0F, 1.0F);
  if (visit.wind > 0.0 && sway > 0.0F) {
    const double reach = visit.wind * static_cast<double>(sway);
    at = pixel(still + reach * Eigen::Vector2d(noise(1, 0.18), noise(2, 0.18)));
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

Canvas OrthoScene::draw(const Window& window, const Visit& visit, double own) const {
  Canvas canvas;
  canvas.window = window;
  canvas.cells = Raster<Cell>(window.rows, window.cols);
  canvas.ground = Raster<float>(window.rows, window.cols);
  canvas.present = Raster<std::uint8_t>(window.rows, window.cols);
  canvas.leaf_depth = leafDepthOf(speciesOf(options_->crop));
  parallelFor(
      static_cast<std::size_t>(window.rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < window.cols; ++c) {
          const Eigen::Vector2d point =
              window.field(window.cell * Eigen::Vector2d(c + 0.5, r + 0.5));
          drawCell(point, visit, static_cast<float>(own), canvas.cells(r, c), canvas.ground(r, c));
          canvas.present(r, c) = valid(point) ? 1 : 0;
        }
      },
      8);
  return canvas;
}

/// A place whose strip is all valid but for 2 %.
StripPlace placeOnMosaic(const OrthoField& field, const OrthoScene& scene,
                         const SimulationOptions& options) {
  const Eigen::Vector2d size(scene.width(), scene.height());
  const double heading = stripHeading(options.ugv, field.row_heading);
  if (stripRoom(options.ugv, size, heading).minCoeff() < 0.0) {
    throw InputError(fmt::format(
        "{}: {:.1f} x {:.1f} m of it are too small for a strip of {} x {} m at {:.0f} degrees; "
        "shorten ugv.length and ugv.width, change ugv.heading_deg, or take more of the mosaic: "
        "field.width and field.height or --window",
        field.name, size.x(), size.y(), options.ugv.length, options.ugv.width,
        heading * 57.29577951308232));
  }
  for (std::uint64_t attempt = 0; attempt < 500; ++attempt) {
    const StripPlace strip =
        placeStrip(options.ugv, size, field.row_heading, hashBits(seedOf(options, 4), attempt));
    if (options.ugv.overhang > 0.0) return strip;
    int good = 0;
    int count = 0;
    const Eigen::Rotation2Dd turn(strip.heading);
    for (double x = -0.5; x <= 0.501; x += 0.02) {
      for (double y = -0.5; y <= 0.501; y += 0.1) {
        const Eigen::Vector2d local(x * options.ugv.length, y * options.ugv.width);
        good += scene.valid(strip.centre + turn * local) ? 1 : 0;
        ++count;
      }
    }
    if (good >= 0.98 * count) return strip;
  }
  throw InputError(fmt::format(
      "{}: no place for a strip of {} x {} m among the valid pixels; shorten ugv.length or change "
      "ugv.heading_deg",
      field.name, options.ugv.length, options.ugv.width));
}

}  // namespace

SimulatedPair simulateFromOrtho(const OrthoField& field, const SimulationOptions& options) {
  checkOptions(options);
  checkField(field);
  OrthoScene scene(field, options);
  const Visit flight = flightOf(options.views, seedOf(options, 2));
  Visit drive = driveOf(options.views, seedOf(options, 3));
  // The flight's wind is in the mosaic already: the drive takes the whole difference.
  drive.wind = options.views.wind / std::sqrt(2.0);

  FieldPoints above;
  {
    Visit still = flight;
    still.wind = 0.0;
    const double cell = std::max(uavCell(options), std::min(field.gsd, options.uav.gsd));
    Canvas canvas =
        scene.draw(makeWindow({0.0, 0.0}, 0.0, scene.width(), scene.height(), cell), still, 0.0);
    lightCanvas(canvas, sunDirection(flight.solar_hour), 1.0);
    above = senseFromAbove(canvas, options.uav, seedOf(options, 5));
  }
  if (options.other_field) scene.mirror();
  const StripPlace strip = placeOnMosaic(field, scene, options);
  Canvas canvas = scene.draw(stripWindow(strip, options.ugv), drive, options.views.leaf_unshared);
  // The mosaic's own light stays; light from another side is added as the sun moves away.
  const double moved = std::min(1.0, std::abs(options.views.sun_hours) / 3.0);
  lightCanvas(canvas, sunDirection(drive.solar_hour),
              1.0 - 0.5 * moved * (1.0 - options.views.overcast));
  FieldPoints below = senseFromGround(canvas, options.ugv, seedOf(options, 7));
  Eigen::Vector3d base = madeUpBase(options.geotag);
  if (options.geotag.utm && field.corner) {
    base << *field.corner, scene.zero();
  }
  SimulatedPair pair =
      assemblePair(options, base, strip, std::move(above), std::move(below), seedOf(options, 8));
  pair.row_heading = field.row_heading;
  pair.overlaps = !options.other_field;
  return pair;
}

}  // namespace agricolmap
