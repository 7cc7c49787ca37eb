#include "agricolmap/simulate/ortho/ortho_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/raster/raster_place.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::simulate {

void listOptions(OptionTable& table, OrthoFileOptions& options) {
  listOptions(table, options.raster);
  table
      .number("gsd", options.gsd, 0.0, 0.1, "m",
              "size of a pixel of the mosaic; 0: as its georeference says")
      .basic();
}

namespace {

constexpr double kCoarsest = 0.1;         // pixels that still show plants [m]
constexpr double kSameGsd = 0.01;         // relative
constexpr double kMaxFieldPixels = 64e6;  // simulating takes about 60 bytes for each
constexpr int kThumbnail = 2000;          // longer side [px]
constexpr double kFull = 0.98;            // share of data that is as good as all
constexpr float kGreen = 0.05F;           // chromatic Excess Green of plants
constexpr std::uint64_t kAttempts = 400;
constexpr double kFarFromMedian = 100.0;  // heights that are not believed [m]

/// Size of a pixel along x and y [m].
Eigen::Vector2d pixelSize(const io::RasterPlace& place, const std::string& name, double gsd) {
  Eigen::Vector2d size = Eigen::Vector2d::Constant(gsd);
  if (place.world_from_pixel) {
    io::checkMetres(name, place);
    const Eigen::Matrix2d pixel = place.world_from_pixel->linear();
    if (!(pixel(0, 0) > 0.0) || !(pixel(1, 1) < 0.0) || pixel(0, 1) != 0.0 || pixel(1, 0) != 0.0) {
      throw InputError(
          fmt::format("{}: is not north up; warp it with gdalwarp, which turns it", name));
    }
    size = {pixel(0, 0), -pixel(1, 1)};
    if (gsd > 0.0 && std::abs(gsd / size.y() - 1.0) > kSameGsd) {
      throw InputError(
          fmt::format("{}: its georeference says pixels of {:.6g} m, not {:.6g} m; leave it out",
                      name, size.y(), gsd),
          Remedy::kPixelSize);
    }
  } else if (gsd <= 0.0) {
    throw InputError(
        fmt::format(
            "{}: has no georeference, so the size of its pixels is unknown; give it in metres",
            name),
        Remedy::kPixelSize);
  }
  if (size.maxCoeff() > kCoarsest) {
    throw InputError(fmt::format("{}: pixels of {:.3g} m show no plants; at most {} m will do",
                                 name, size.maxCoeff(), kCoarsest));
  }
  return size;
}

/// A grid with square cells, row 0 south, over the area of a mosaic.
GridFrame squareGrid(const io::RasterImage& mosaic) {
  const Eigen::Affine2d& world = *mosaic.place.world_from_pixel;
  GridFrame grid;
  grid.cell = -world.linear()(1, 1);
  grid.corner = world * Eigen::Vector2d(0.0, mosaic.colour.rows());
  grid.rows = mosaic.colour.rows();
  grid.cols =
      std::max(1, static_cast<int>(mosaic.colour.cols() * world.linear()(0, 0) / grid.cell + 1e-6));
  return grid;
}

/// Bilinear mean of `value(row, col)` of a raster at the centre of each cell: `put(cell, mean)`
/// takes it, NaN outside the raster.
template <typename Value, typename Put>
void resample(const GridFrame& grid, const Eigen::Affine2d& world, int rows, int cols,
              const Value& value, const Put& put) {
  const Eigen::Affine2d pixel_from_world = world.inverse();
  parallelFor(
      static_cast<std::size_t>(grid.rows),
      [&](std::size_t r) {
        for (int c = 0; c < grid.cols; ++c) {
          const std::size_t cell = r * static_cast<std::size_t>(grid.cols) + c;
          const Eigen::Vector2d at = pixel_from_world * grid.centre(static_cast<double>(r), c) -
                                     Eigen::Vector2d::Constant(0.5);
          // Between the border and the centres of the pixels along it counts as in the raster.
          if (!(at.minCoeff() > -0.501 && at.x() < cols - 0.499 && at.y() < rows - 0.499)) {
            put(cell, std::numeric_limits<double>::quiet_NaN());
            continue;
          }
          put(cell, cellsClamped<double>(rows, cols, at.x(), at.y()).mean(value));
        }
      },
      16);
}

void resampleColours(const io::RasterImage& mosaic, const GridFrame& grid, OrthoField& field) {
  const Eigen::Affine2d& world = *mosaic.place.world_from_pixel;
  const int rows = mosaic.colour.rows();
  const int cols = mosaic.colour.cols();
  field.colour = Raster<Rgb>(grid.rows, grid.cols);
  field.valid = Raster<std::uint8_t>(grid.rows, grid.cols, 0);
  for (std::uint8_t Rgb::*band : {&Rgb::r, &Rgb::g, &Rgb::b}) {
    resample(
        grid, world, rows, cols,
        [&](int r, int c) { return static_cast<double>(mosaic.colour(r, c).*band); },
        [&](std::size_t i, double mean) {
          if (mean >= 0.0) field.colour[i].*band = static_cast<std::uint8_t>(mean + 0.5);
        });
  }
  resample(
      grid, world, rows, cols, [&](int r, int c) { return mosaic.valid(r, c) != 0 ? 1.0 : 0.0; },
      [&](std::size_t i, double share) { field.valid[i] = share > 0.999 ? 1 : 0; });
}

/// The pixels of a model that the grid lies on, with a margin for interpolation; nothing where it
/// lies beside the model.
std::optional<io::PixelWindow> windowUnder(const GridFrame& grid, const io::RasterShape& model) {
  const Eigen::Affine2d pixel_from_world = model.place.world_from_pixel->inverse();
  const Eigen::Vector2d size = grid.cell * Eigen::Vector2d(grid.cols, grid.rows);
  Eigen::AlignedBox2d box;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0}) {
      box.extend(pixel_from_world * (grid.corner + Eigen::Vector2d(x * size.x(), y * size.y())));
    }
  }
  const Eigen::AlignedBox2d all(Eigen::Vector2d::Zero(), Eigen::Vector2d(model.cols, model.rows));
  box = box.intersection(all);
  if (box.isEmpty()) return {};
  const Eigen::Vector2i low = (box.min().array().floor() - 2.0).cwiseMax(0.0).cast<int>();
  const Eigen::Vector2i high = (box.max().array().ceil() + 2.0).min(all.max().array()).cast<int>();
  return io::PixelWindow{low.x(), low.y(), high.x() - low.x(), high.y() - low.y()};
}

/// Gives each cell that is NaN the value of the nearest one in its row; rows without any get those
/// of the row below or above. The simulator wants numbers, and blurs them into the cells around.
void fillGaps(Raster<float>& raster) {
  const int cols = raster.cols();
  for (int r = 0; r < raster.rows(); ++r) {
    float* const row = raster.row(r);
    int last = -1;  // last cell with a value
    for (int c = 0; c < cols; ++c) {
      if (std::isnan(row[c])) continue;
      const int middle = last < 0 ? 0 : (last + c + 1) / 2;
      if (last >= 0) std::fill(row + last + 1, row + middle, row[last]);
      std::fill(row + middle, row + c, row[c]);
      last = c;
    }
    if (last >= 0) std::fill(row + last + 1, row + cols, row[last]);
  }
  const auto is_empty = [&](int r) { return std::isnan(raster(r, 0)); };
  for (int r = 1; r < raster.rows(); ++r) {
    if (is_empty(r) && !is_empty(r - 1)) std::copy_n(raster.row(r - 1), cols, raster.row(r));
  }
  for (int r = raster.rows() - 2; r >= 0; --r) {
    if (is_empty(r)) std::copy_n(raster.row(r + 1), cols, raster.row(r));
  }
}

/// Heights of a model on the field's grid. Cells without one become invalid and get a height from
/// nearby.
Raster<float> resampleHeights(const std::filesystem::path& path, const io::RasterImage& mosaic,
                              const GridFrame& grid, OrthoField& field) {
  const io::RasterShape shape = io::readRasterShape(path);
  io::checkMetres(shape.name, shape.place);
  const auto warning = io::checkSameCrs(mosaic.name, mosaic.place, shape.name, shape.place);
  if (warning) field.warnings.push_back(*warning);
  const std::optional<io::PixelWindow> window = windowUnder(grid, shape);
  Raster<float> result(grid.rows, grid.cols, std::numeric_limits<float>::quiet_NaN());
  bool any = false;
  if (window) {
    io::RasterHeights heights = io::readHeights(path, {.window = window});
    field.warnings.insert(field.warnings.end(), heights.warnings.begin(), heights.warnings.end());
    io::removeFarHeights(heights.height, kFarFromMedian);
    resample(
        grid, *heights.place.world_from_pixel, heights.height.rows(), heights.height.cols(),
        [&](int r, int c) { return static_cast<double>(heights.height(r, c)); },
        [&](std::size_t i, double mean) { result[i] = static_cast<float>(mean); });
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (std::isnan(result[i])) field.valid[i] = 0;
      any = any || field.valid[i] != 0;
    }
  }
  if (!any) {
    throw InputError(fmt::format(
        "no pixel of {} ({}) has a height in {} ({}); do the two show the same field?", mosaic.name,
        io::extentOf(mosaic.place, mosaic.colour.rows(), mosaic.colour.cols()), shape.name,
        io::extentOf(shape.place, shape.rows, shape.cols)));
  }
  fillGaps(result);
  return result;
}

/// Share of the thumbnail's pixels with data in any rectangle, in constant time.
class DataShare {
 public:
  explicit DataShare(const Raster<std::uint8_t>& valid)
      : sums_(valid.rows() + 1, valid.cols() + 1, 0) {
    for (int r = 0; r < valid.rows(); ++r) {
      int row_sum = 0;
      for (int c = 0; c < valid.cols(); ++c) {
        row_sum += valid(r, c);
        sums_(r + 1, c + 1) = sums_(r, c + 1) + row_sum;
      }
    }
  }
  double of(const io::PixelWindow& window, int step) const {
    const auto [top, bottom] = range(window.row, window.rows, step, sums_.rows() - 1);
    const auto [left, right] = range(window.col, window.cols, step, sums_.cols() - 1);
    const int sum =
        sums_(bottom, right) - sums_(top, right) - sums_(bottom, left) + sums_(top, left);
    return static_cast<double>(sum) / (1.0 * (bottom - top) * (right - left));
  }

 private:
  static std::pair<int, int> range(int first, int count, int step, int end) {
    const int low = std::min(first / step, end - 1);
    return {low, std::clamp((first + count) / step, low + 1, end)};
  }
  Raster<int> sums_;
};

/// Pixels that are greener than grey; all that have data where none is.
std::vector<std::size_t> plantPixels(const io::RasterImage& image) {
  std::vector<std::size_t> plants;
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < image.valid.size(); ++i) {
    if (image.valid[i] == 0) continue;
    all.push_back(i);
    if (map::excessGreen(image.colour[i], map::ExgKind::kChromatic) > kGreen) plants.push_back(i);
  }
  return plants.empty() ? all : plants;
}

}  // namespace

io::PixelWindow chooseWindow(const std::filesystem::path& ortho, const OrthoFileOptions& options,
                             double width, double height, std::uint64_t seed) {
  checkOptions(options);
  const io::RasterShape shape = io::readRasterShape(ortho);
  const Eigen::Vector2d pixel = pixelSize(shape.place, shape.name, options.gsd);
  const auto count = [](double length, double size, int most) {
    return static_cast<int>(std::clamp(std::round(length / size), 1.0, 1.0 * most));
  };
  io::PixelWindow window{0, 0, count(width, pixel.x(), shape.cols),
                         count(height, pixel.y(), shape.rows)};
  if (window.cols == shape.cols && window.rows == shape.rows) return window;

  const int step = std::max(1, (std::max(shape.cols, shape.rows) + kThumbnail - 1) / kThumbnail);
  const io::RasterImage thumbnail =
      io::readRaster(ortho, options.raster, {.window = {}, .step = step});
  const std::vector<std::size_t> plants = plantPixels(thumbnail);
  const DataShare share(thumbnail.valid);
  Random random = Random::stream(seed, 0x0E71);
  io::PixelWindow best = window;
  double best_share = -1.0;
  for (std::uint64_t attempt = 0; attempt < kAttempts && best_share < kFull; ++attempt) {
    const std::size_t middle = plants[random.below(plants.size())];
    const auto cols = static_cast<std::size_t>(thumbnail.valid.cols());
    window.col = std::clamp(static_cast<int>(middle % cols) * step - window.cols / 2, 0,
                            shape.cols - window.cols);
    window.row = std::clamp(static_cast<int>(middle / cols) * step - window.rows / 2, 0,
                            shape.rows - window.rows);
    const double found = share.of(window, step);
    if (found > best_share) {
      best_share = found;
      best = window;
    }
  }
  return best;
}

OrthoField readOrtho(const OrthoFiles& files, const OrthoFileOptions& options,
                     const std::optional<io::PixelWindow>& window) {
  checkOptions(options);
  const io::RasterShape shape = io::readRasterShape(files.ortho);
  const Eigen::Vector2d pixel = pixelSize(shape.place, shape.name, options.gsd);
  const bool georeferenced = shape.place.world_from_pixel.has_value();
  if (!files.dsm.empty() && !georeferenced) {
    throw InputError(
        fmt::format("{}: has no georeference, so the heights of {} cannot be laid on it; give it "
                    "its place with gdal_translate -a_ullr and -a_srs",
                    shape.name, files.dsm.string()));
  }
  if (!files.dtm.empty() && files.dsm.empty()) {
    throw UsageError(
        fmt::format("{}: a terrain model needs a surface model, too", files.dtm.string()),
        Remedy::kSurfaceModel);
  }
  const double pixels = window ? 1.0 * window->cols * window->rows : 1.0 * shape.cols * shape.rows;
  if (pixels > kMaxFieldPixels) {
    throw InputError(
        fmt::format("{}: a field of {:.0f} million pixels is too large to simulate (limit {:.0f} "
                    "million); take "
                    "a smaller window or field.width and field.height, or thin the mosaic with "
                    "gdal_translate -outsize",
                    shape.name, pixels / 1e6, kMaxFieldPixels / 1e6),
        Remedy::kWindow);
  }
  io::RasterImage mosaic = io::readRaster(files.ortho, options.raster, {.window = window});
  if (!georeferenced) {
    // From the south-west corner.
    mosaic.place.world_from_pixel = Eigen::Translation2d(0.0, pixel.y() * mosaic.colour.rows()) *
                                    Eigen::Scaling(pixel.x(), -pixel.y());
  }
  const GridFrame grid = squareGrid(mosaic);
  OrthoField field;
  field.name = mosaic.name;
  field.gsd = grid.cell;
  field.warnings = mosaic.warnings;
  if (georeferenced) field.corner = grid.corner;
  resampleColours(mosaic, grid, field);
  if (!files.dsm.empty()) field.height = resampleHeights(files.dsm, mosaic, grid, field);
  if (!files.dtm.empty()) field.ground = resampleHeights(files.dtm, mosaic, grid, field);
  return field;
}

}  // namespace agricolmap::simulate
