#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/field/colour_response.hpp"
#include "agricolmap/simulate/field/mosaic_pieces.hpp"
#include "agricolmap/simulate/field/noise.hpp"
#include "agricolmap/simulate/field/views.hpp"

namespace agricolmap::simulate {

namespace {

/// What the reconstruction knows: heights and light on a lattice of about one ground sampling
/// distance.
struct Reconstruction {
  Raster<float> z;
  std::array<Raster<float>, 3> light;
  double cell = 0.0;
  double mean_light = 0.0;
};

/// Averages blocks of cells; lowers the canopy by `underestimate`.
Reconstruction averageBlocks(const Canvas& canvas, const UavOptions& options, std::uint64_t seed) {
  const int block = std::max(1, static_cast<int>(std::lround(options.gsd / canvas.window.cell)));
  const int rows = (canvas.window.rows + block - 1) / block;
  const int cols = (canvas.window.cols + block - 1) / block;
  Reconstruction result;
  result.cell = canvas.window.cell * block;
  result.z = Raster<float>(rows, cols);
  for (Raster<float>& channel : result.light) channel = Raster<float>(rows, cols);
  parallelFor(
      static_cast<std::size_t>(rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < cols; ++c) {
          // How much of the canopy's height is lost differs from place to place.
          const float lost = static_cast<float>(options.underestimate) *
                             std::max(0.0F, 1.0F + 0.3F * noiseAt(seed + 5, c * result.cell / 0.6,
                                                                  r * result.cell / 0.6));
          float z = 0.0F;
          std::array<float, 3> light{};
          int count = 0;
          for (int y = r * block; y < std::min((r + 1) * block, canvas.window.rows); ++y) {
            for (int x = c * block; x < std::min((c + 1) * block, canvas.window.cols); ++x) {
              const float ground = canvas.ground(y, x);
              z += ground + (1.0F - lost) * (canvas.cells(y, x).z - ground);
              const std::array<float, 3> radiance = canvas.radiance(y, x);
              for (std::size_t k = 0; k < 3; ++k) light[k] += radiance[k];
              ++count;
            }
          }
          const float scale = 1.0F / static_cast<float>(count);
          result.z(r, c) = scale * z;
          for (std::size_t k = 0; k < 3; ++k) result.light[k](r, c) = scale * light[k];
        }
      },
      16);
  result.mean_light =
      parallelSum(result.z.size(), 1U << 16, 0.0, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += static_cast<double>(result.light[1][i]);
        return sum;
      });
  result.mean_light /= static_cast<double>(result.z.size());
  return result;
}

class Sampler {
 public:
  Sampler(const Canvas& canvas, const UavOptions& options, std::uint64_t seed)
      : options_(&options),
        seed_(seed),
        canvas_(&canvas),
        window_(&canvas.window),
        scene_(averageBlocks(canvas, options, seed)),
        colour_(options.colour, scene_.mean_light, seed),
        pieces_(options.mosaic, {canvas.window.width(), canvas.window.height()}, seed),
        hole_(normalQuantile(options.holes)) {
    blurRaster(scene_.z, options.smoothing / scene_.cell);
    for (Raster<float>& channel : scene_.light)
      blurRaster(channel, options.colour_blur * options.gsd / scene_.cell);
    if (options.mosaic.blur <= 0.0) return;
    soft_ = scene_.light;
    for (Raster<float>& channel : soft_)
      blurRaster(channel, options.mosaic.blur * options.gsd / scene_.cell);
  }

  int rows() const { return static_cast<int>(std::ceil(window_->height() / options_->gsd)); }

  /// The points of one row of the sampling lattice.
  FieldPoints row(int r) const {
    FieldPoints points;
    Random random = Random::stream(seed_ ^ 0x55A7, static_cast<std::uint64_t>(r));
    const int cols = static_cast<int>(std::ceil(window_->width() / options_->gsd));
    points.xyz.reserve(static_cast<std::size_t>(cols * options_->density * 1.1) + 16);
    points.rgb.reserve(points.xyz.capacity());
    const auto whole = static_cast<int>(options_->density);
    for (int c = 0; c < cols; ++c) {
      const int count = whole + (random.chance(options_->density - whole) ? 1 : 0);
      for (int k = 0; k < count; ++k) addPoint(c, r, random, points);
    }
    return points;
  }

 private:
  void addPoint(int c, int r, Random& random, FieldPoints& points) const {
    const double spread = options_->jitter;
    const Eigen::Vector2d local(
        options_->gsd * (c + 0.5 + spread * (2.0 * random.uniform() - 1.0)),
        options_->gsd * (r + 0.5 + spread * (2.0 * random.uniform() - 1.0)));
    if (local.x() < 0.0 || local.y() < 0.0 || local.x() > window_->width() ||
        local.y() > window_->height()) {
      return;
    }
    if (!canvas_->isPresent(
            std::min(static_cast<int>(local.y() / window_->cell), window_->rows - 1),
            std::min(static_cast<int>(local.x() / window_->cell), window_->cols - 1))) {
      return;
    }
    // Where the matching found nothing: patches of about 20 cm.
    const float hole = noiseAt(seed_ + 9, local.x() / 0.25, local.y() / 0.25) * 0.8F +
                       noiseAt(seed_ + 10, local.x() / 0.06, local.y() / 0.06) * 0.4F;
    if (hole > hole_) return;
    const Eigen::Vector2d shown = local - pieces_.displacement(local);
    const auto col = static_cast<float>(shown.x() / scene_.cell - 0.5);
    const auto row = static_cast<float>(shown.y() / scene_.cell - 0.5);
    const Eigen::Vector2d place = window_->field(local);
    // A dome: radial error that grows with the square of the distance from the middle.
    const Eigen::Vector2d half(0.5 * window_->width(), 0.5 * window_->height());
    const double dome = options_->dome * ((local - half).squaredNorm() / half.squaredNorm() - 0.5);
    const double correlated =
        options_->correlated_noise *
        static_cast<double>(noiseAt(seed_ + 7, local.x() / 0.15, local.y() / 0.15));
    const double z = static_cast<double>(sampleRaster(scene_.z, col, row)) + dome + correlated +
                     random.normal(options_->height_noise);
    points.xyz.emplace_back(static_cast<float>(place.x()), static_cast<float>(place.y()),
                            static_cast<float>(z));
    const std::array<float, 3> light =
        pieces_.any() ? lightOf(pieces_.at(local), col, row) : lightAt(scene_.light, col, row);
    points.rgb.push_back(colour_(light, place, random));
  }

  static std::array<float, 3> lightAt(const std::array<Raster<float>, 3>& light, float col,
                                      float row) {
    return {sampleRaster(light[0], col, row), sampleRaster(light[1], col, row),
            sampleRaster(light[2], col, row)};
  }
  /// As a piece of the mosaic shows it.
  std::array<float, 3> lightOf(const MosaicPiece& piece, float col, float row) const {
    const Eigen::Vector2f apart = (piece.doubled / scene_.cell).cast<float>();
    std::array<float, 3> light{};
    for (const float image : {-0.5F, 0.5F}) {
      const float c = col + image * apart.x();
      const float r = row + image * apart.y();
      const std::array<float, 3> sharp = lightAt(scene_.light, c, r);
      const std::array<float, 3> soft = soft_[0].empty() ? sharp : lightAt(soft_, c, r);
      for (std::size_t k = 0; k < 3; ++k) {
        light[k] += 0.5F * piece.exposure * (sharp[k] + piece.blur * (soft[k] - sharp[k]));
      }
    }
    return light;
  }

  const UavOptions* options_;
  std::uint64_t seed_;
  const Canvas* canvas_;
  const Window* window_;
  Reconstruction scene_;
  std::array<Raster<float>, 3> soft_;  ///< light, blurred further; empty: no piece is
  ColourResponse colour_;
  MosaicPieces pieces_;
  float hole_;
};

}  // namespace

FieldPoints senseFromAbove(const Canvas& canvas, const UavOptions& options, std::uint64_t seed) {
  const Sampler sampler(canvas, options, seed);
  std::vector<FieldPoints> rows(static_cast<std::size_t>(sampler.rows()));
  parallelFor(
      rows.size(), [&](std::size_t r) { rows[r] = sampler.row(static_cast<int>(r)); }, 8);
  return joinPoints(rows);
}

FieldPoints joinPoints(const std::vector<FieldPoints>& parts) {
  std::vector<std::size_t> begin(parts.size() + 1, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) begin[i + 1] = begin[i] + parts[i].xyz.size();
  FieldPoints all;
  all.xyz.resize(begin.back());
  all.rgb.resize(begin.back());
  parallelFor(
      parts.size(),
      [&](std::size_t i) {
        std::copy(parts[i].xyz.begin(), parts[i].xyz.end(),
                  all.xyz.begin() + static_cast<std::ptrdiff_t>(begin[i]));
        std::copy(parts[i].rgb.begin(), parts[i].rgb.end(),
                  all.rgb.begin() + static_cast<std::ptrdiff_t>(begin[i]));
      },
      8);
  return all;
}

}  // namespace agricolmap::simulate
