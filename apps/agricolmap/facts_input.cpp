#include "facts_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/level.hpp"

namespace agricolmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSigmaCells = 0.6;   // of the mean of a cell's points
constexpr double kLeastCell = 0.004;  // finer ones show a leaf's veins [m]
constexpr double kMostCells = 40e6;   // of a map that has finer layers in places

/// A layer with its place, row 0 southernmost.
struct Layer {
  GridFrame frame;  ///< file coordinates [m]
  Raster<float> values;
  std::string crs;
};

Layer readLayer(const std::filesystem::path& path) {
  io::RasterHeights raster = io::readHeights(path);
  const std::string name = path.string();
  if (!raster.place.world_from_pixel) {
    throw InputError(fmt::format("{}: does not say where it lies", name));
  }
  const Eigen::Affine2d& world = *raster.place.world_from_pixel;
  const double cell = world(0, 0);
  const bool upright = std::abs(world(0, 1)) < 1e-9 * cell && std::abs(world(1, 0)) < 1e-9 * cell &&
                       std::abs(world(1, 1) + cell) < 1e-6 * cell;
  if (!(cell > 0.0) || !upright) {
    throw InputError(fmt::format("{}: its cells are no squares with north up", name));
  }
  Layer layer;
  layer.crs = raster.place.crs;
  layer.frame.cell = cell;
  layer.frame.rows = raster.height.rows();
  layer.frame.cols = raster.height.cols();
  layer.frame.corner = world * Eigen::Vector2d(0.0, layer.frame.rows);
  layer.values = Raster<float>(layer.frame.rows, layer.frame.cols);
  for (int r = 0; r < layer.frame.rows; ++r) {
    std::copy_n(raster.height.row(layer.frame.rows - 1 - r), layer.frame.cols, layer.values.row(r));
  }
  return layer;
}

bool sameLattice(const GridFrame& a, const GridFrame& b) {
  return a.rows == b.rows && a.cols == b.cols && std::abs(a.cell - b.cell) < 1e-9 &&
         (a.corner - b.corner).norm() < 1e-3 * a.cell;
}

/// The value under `point`; of a layer with finer cells the mean of those within `side`.
float valueAt(const Layer& layer, const Eigen::Vector2d& point, double side) {
  const Eigen::Vector2d at = layer.frame.cellOf(point);
  const int reach = static_cast<int>((0.5 * side / layer.frame.cell) + 1e-6);
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  float sum = 0.0F;
  float count = 0.0F;
  for (int r = row - reach; r <= row + reach; ++r) {
    for (int c = col - reach; c <= col + reach; ++c) {
      if (!layer.values.contains(r, c) || !std::isfinite(layer.values(r, c))) continue;
      sum += layer.values(r, c);
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : kNone;
}

/// The layer on finer cells: the fine one's values where it has any.
Raster<float> merged(const Layer& coarse, const Layer& fine, const GridFrame& frame) {
  Raster<float> result(frame.rows, frame.cols, kNone);
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      const Eigen::Vector2d point = frame.centre(r, c);
      const float value = valueAt(fine, point, frame.cell - fine.frame.cell);
      result(r, c) = std::isfinite(value) ? value : valueAt(coarse, point, 0.0);
    }
  }
  return result;
}

FactsInput readMapFolder(const std::filesystem::path& folder) {
  const std::filesystem::path layers = folder / "layers";
  Layer exg = readLayer(layers / "exg.tif");
  Layer height = readLayer(layers / "plant_height.tif");
  if (!sameLattice(exg.frame, height.frame)) {
    throw InputError(
        fmt::format("{}: exg.tif and plant_height.tif have not the same cells; make "
                    "the map anew",
                    layers.string()));
  }
  FactsInput input;
  input.above_ground = true;
  if (const auto crs = io::crsFromWkt(exg.crs)) input.crs = *crs;
  input.frame = exg.frame;
  const std::filesystem::path fine = folder / "fine";
  std::error_code error;
  if (std::filesystem::exists(fine / "exg.tif", error)) {
    const Layer fine_exg = readLayer(fine / "exg.tif");
    const Layer fine_height = readLayer(fine / "plant_height.tif");
    const double cells = static_cast<double>(exg.values.size());
    const double ratio = std::round(exg.frame.cell / fine_exg.frame.cell);
    const int finer =
        static_cast<int>(std::clamp(std::floor(std::sqrt(kMostCells / cells)), 1.0, ratio));
    input.frame.cell /= finer;
    input.frame.rows *= finer;
    input.frame.cols *= finer;
    input.exg = merged(exg, fine_exg, input.frame);
    input.height = merged(height, fine_height, input.frame);
  } else {
    input.exg = std::move(exg.values);
    input.height = std::move(height.values);
  }
  input.origin = input.frame.corner.array().floor().matrix();
  input.frame.corner -= input.origin;
  return input;
}

/// Heights become those above the field's plane, places stay.
Eigen::Affine3d flattened(const map::Levelling& levelling) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.matrix().row(2) = levelling.levelled_from_guess.matrix().row(2);
  return result;
}

/// Points of a cloud leave cells empty that lie between seen ones: these take their neighbours'
/// mean.
void fillBetween(Raster<float>& values) {
  constexpr int kLeastNeighbours = 3;
  const Raster<float> before = values;
  for (int row = 1; row + 1 < values.rows(); ++row) {
    for (int col = 1; col + 1 < values.cols(); ++col) {
      if (std::isfinite(before(row, col))) continue;
      float sum = 0.0F;
      int count = 0;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
          if (!std::isfinite(before(r, c))) continue;
          sum += before(r, c);
          ++count;
        }
      }
      if (count >= kLeastNeighbours) values(row, col) = sum / static_cast<float>(count);
    }
  }
}

FactsInput readCloudInput(const std::string& path, const std::string& given, Progress& progress) {
  const io::MapFiles files = io::mapFilesOf(path);
  const io::FileCrs crs = io::crsOfMap(files, given);
  printWarnings(crs.warnings);
  if (crs.crs && !io::isProjected(*crs.crs)) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees ({}); bring them into a projected system first: "
        "agricolmap convert --to-crs",
        path, crs.crs->name));
  }
  io::StreamOptions options;
  options.on_pass = [&](std::size_t seen, std::size_t of) { progress.points(seen, of); };
  const std::unique_ptr<PointStream> cloud = io::streamMap(files, options);
  const map::Levelling levelling =
      map::levelCloud(*cloud, Eigen::Affine3d::Identity(), map::LevelOptions());
  const Eigen::Affine3d flat = flattened(levelling);
  const map::Footprint footprint = map::footprintOf(*cloud, flat);
  map::GridOptions grid;
  grid.cell = std::max(kLeastCell, footprint.spacing());
  grid.sigma = kSigmaCells * grid.cell;
  grid.coarsen = false;
  map::GridMap gridded = map::makeGridMap(*cloud, flat, footprint.box, grid);
  FactsInput input;
  if (crs.crs) input.crs = *crs.crs;
  input.frame = gridded.frame;
  input.origin = cloud->facts().origin.head<2>();
  for (std::size_t i = 0; i < gridded.exg.size(); ++i) {
    if (gridded.valid(i)) continue;
    gridded.exg[i] = kNone;
    gridded.height[i] = kNone;
  }
  fillBetween(gridded.exg);
  fillBetween(gridded.height);
  input.exg = std::move(gridded.exg);
  input.height = std::move(gridded.height);
  return input;
}

}  // namespace

FactsInput readFactsInput(const std::string& path, const std::string& crs, Progress& progress) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return readCloudInput(path, crs, progress);
  if (!crs.empty()) throw UsageError("--crs is for clouds; a map says where it lies");
  return readMapFolder(path);
}

}  // namespace agricolmap
