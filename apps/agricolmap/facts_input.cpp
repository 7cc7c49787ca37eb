#include "facts_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/level.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kSigmaCells = 0.6;   // of the mean of a cell's points
constexpr double kLeastCell = 0.004;  // finer ones show a leaf's veins [m]
constexpr double kMostCells = 40e6;   // of a map that has finer layers in places

/// What a strip shows in cells of its own.
struct FineStrip {
  GridFrame frame;  ///< file coordinates [m]
  Raster<float> exg;
  Raster<float> height;
};

/// Corner in file coordinates.
GridFrame placedFrame(const io::LayerShape& shape) {
  GridFrame frame = shape.frame;
  frame.corner += shape.origin.head<2>();
  return frame;
}

bool sameLattice(const GridFrame& a, const GridFrame& b) {
  return a.rows == b.rows && a.cols == b.cols && std::abs(a.cell - b.cell) < 1e-9 &&
         (a.corner - b.corner).norm() < 1e-3 * a.cell;
}

/// The band of that name, as `fuse` calls it. Throws InputError where there is none.
Raster<float> bandOf(io::Layer<float>& layer, const std::string& name) {
  for (std::size_t i = 0; i < layer.bands.size(); ++i) {
    if (layer.shape.bands[i] == name) return std::move(layer.bands[i]);
  }
  throw InputError(fmt::format("{}: has no band '{}'; make the map anew", layer.shape.name, name));
}

std::vector<FineStrip> fineStripsOf(const std::filesystem::path& folder) {
  std::vector<FineStrip> strips;
  for (const report::MapSource& source : report::readSharedMap(folder).strips) {
    const std::filesystem::path path = folder / "fine" / (source.id + ".tif");
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;  // one that owns nothing
    io::Layer<float> layer = io::readLayer<float>(path);
    strips.push_back(
        {placedFrame(layer.shape), bandOf(layer, "excess green"), bandOf(layer, "plant height")});
  }
  return strips;
}

/// The mean of the cells within `side` of `point`; one cell where that is no more.
float valueAt(const GridFrame& frame, const Raster<float>& values, const Eigen::Vector2d& point,
              double side) {
  const Eigen::Vector2d at = frame.cellOf(point);
  const int reach = static_cast<int>((0.5 * side / frame.cell) + 1e-6);
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  float sum = 0.0F;
  float count = 0.0F;
  for (int r = row - reach; r <= row + reach; ++r) {
    for (int c = col - reach; c <= col + reach; ++c) {
      if (!values.contains(r, c) || !std::isfinite(values(r, c))) continue;
      sum += values(r, c);
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : kNone;
}

/// Each cell cut into `finer` × `finer` of the same value.
Raster<float> cut(const Raster<float>& coarse, int finer) {
  Raster<float> fine(coarse.rows() * finer, coarse.cols() * finer);
  for (int r = 0; r < fine.rows(); ++r) {
    for (int c = 0; c < fine.cols(); ++c) fine(r, c) = coarse(r / finer, c / finer);
  }
  return fine;
}

/// Puts a strip's values in place of the map's, where it has any.
void paint(const GridFrame& from, const Raster<float>& values, const GridFrame& frame,
           Raster<float>& into) {
  const Eigen::Vector2d low = frame.cellOf(from.corner);
  const Eigen::Vector2d high =
      frame.cellOf(from.corner + from.cell * Eigen::Vector2d(from.cols, from.rows));
  const int row_end = std::min(frame.rows, static_cast<int>(std::ceil(high.y())) + 1);
  const int col_end = std::min(frame.cols, static_cast<int>(std::ceil(high.x())) + 1);
  for (int r = std::max(0, static_cast<int>(std::floor(low.y()))); r < row_end; ++r) {
    for (int c = std::max(0, static_cast<int>(std::floor(low.x()))); c < col_end; ++c) {
      const float value = valueAt(from, values, frame.centre(r, c), frame.cell - from.cell);
      if (std::isfinite(value)) into(r, c) = value;
    }
  }
}

FactsInput readMapFolder(const std::filesystem::path& folder) {
  const std::vector<FineStrip> strips = fineStripsOf(folder);
  io::Layer<float> exg = io::readLayer<float>(folder / "layers/exg.tif");
  FactsInput input;
  input.above_ground = true;
  if (const auto crs = io::crsFromWkt(exg.shape.crs)) input.crs = *crs;
  input.frame = placedFrame(exg.shape);
  input.exg = std::move(exg.bands.front());
  std::error_code ignored;
  // A map of clouds without heights has no such layer.
  if (const auto path = folder / "layers/plant_height.tif";
      std::filesystem::exists(path, ignored)) {
    io::Layer<float> height = io::readLayer<float>(path);
    if (!sameLattice(input.frame, placedFrame(height.shape))) {
      throw InputError(
          fmt::format("{}: has not the cells of exg.tif; make the map anew", path.string()));
    }
    input.height = std::move(height.bands.front());
  }
  if (!strips.empty()) {
    const double most = std::sqrt(kMostCells / static_cast<double>(input.exg.size()));
    const double ratio = std::round(input.frame.cell / strips.front().frame.cell);
    const int finer = static_cast<int>(std::clamp(std::floor(most), 1.0, std::max(1.0, ratio)));
    input.frame.cell /= finer;
    input.frame.rows *= finer;
    input.frame.cols *= finer;
    input.exg = cut(input.exg, finer);
    if (!input.height.empty()) input.height = cut(input.height, finer);
    for (const FineStrip& strip : strips) {
      paint(strip.frame, strip.exg, input.frame, input.exg);
      if (!input.height.empty()) paint(strip.frame, strip.height, input.frame, input.height);
    }
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
  // An orthomosaic without a surface model is laid flat: that is no plants of no height.
  if (map::hasRelief(gridded)) {
    fillBetween(gridded.height);
    input.height = std::move(gridded.height);
  }
  fillBetween(gridded.exg);
  input.exg = std::move(gridded.exg);
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
