#include "change_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "agricolmap/change/common_grid.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/raster/raster_place.hpp"
#include "agricolmap/io/raster/surface_layer.hpp"

namespace agricolmap {
namespace fs = std::filesystem;
namespace {

/// The frame about another origin.
GridFrame aboutOrigin(const io::LayerShape& shape, const Eigen::Vector3d& origin) {
  GridFrame frame = shape.frame;
  frame.corner += (shape.origin - origin).head<2>();
  return frame;
}

}  // namespace

ChangeMap::ChangeMap(const std::string& name, const std::optional<GivenError>& error,
                     const char* flag)
    : name_(name), error_(error) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) folder_ = report::readSharedMap(name);
  shape_ = io::readLayerShape(flat() ? layerFile("cover") : surfaceFile());
  io::checkMetres(shape_.name, io::placeOf(shape_));
  if (!flat() && !error_ && !(folder_ && folder_->layer("error"))) {
    throw UsageError(fmt::format(
        "{}: nothing is known of its errors; say which RMS is expected of its heights and places, "
        "in metres: {} HEIGHT PLANE",
        name, flag));
  }
}

fs::path ChangeMap::surfaceFile() const { return folder_ ? layerFile("surface") : fs::path(name_); }

fs::path ChangeMap::layerFile(const char* layer) const {
  if (const auto file = folder_->layer(layer)) return *file;
  throw InputError(fmt::format(
      "{}: has no layer layers/{}.tif; make the map anew with agricolmap fuse", name_, layer));
}

ChangeMap::Part ChangeMap::partFor(const GridFrame& grid, const Eigen::Vector3d& origin) const {
  const GridFrame own = aboutOrigin(shape_, origin);
  const double side = grid.cell / own.cell;
  const Eigen::Array2d low = (grid.corner - own.corner).array() / own.cell;
  const Eigen::Array2d high = low + side * Eigen::Array2d(grid.cols, grid.rows);
  // A cell more on each side: what rounding takes is not worth a thought.
  const Eigen::Array2d size(own.cols, own.rows);
  const Eigen::Array2i first = (low.floor() - 1.0).max(0.0).cast<int>();
  const Eigen::Array2i last = (high.ceil() + 1.0).min(size).cast<int>();
  Part part;
  part.window = {first.y(), first.x(), last.y() - first.y(), last.x() - first.x()};
  part.frame = {own.corner + own.cell * first.matrix().cast<double>(), own.cell, part.window.rows,
                part.window.cols};
  return part;
}

void ChangeMap::requireOwnGrid(const fs::path& file) const {
  const io::LayerShape other = io::readLayerShape(file);
  if (change::sameGrid(aboutOrigin(other, shape_.origin), shape_.frame)) return;
  throw InputError(
      fmt::format("{}: has another grid than {}: {} x {} cells of {:g} m, not {} x {} of {:g} m; "
                  "make the map anew with agricolmap fuse",
                  file.string(), shape_.name, other.frame.cols, other.frame.rows, other.frame.cell,
                  shape_.frame.cols, shape_.frame.rows, shape_.frame.cell));
}

Raster<float> ChangeMap::surfaceIn(const io::CellWindow& window,
                                   std::vector<std::string>& warnings) const {
  if (folder_) return io::readLayer<float>(surfaceFile(), window).bands.front();
  io::SurfaceLayer surface = io::readSurfaceLayer(name_, shape_, window);
  warnings.insert(warnings.end(), surface.warnings.begin(), surface.warnings.end());
  return std::move(surface.height);
}

void ChangeMap::readErrors(const Part& part, const GridFrame& grid,
                           change::MapHeights& heights) const {
  if (error_) {
    heights.height_error = Raster<float>(grid.rows, grid.cols, static_cast<float>(error_->height));
    heights.plane_error = Raster<float>(grid.rows, grid.cols, static_cast<float>(error_->plane));
    return;
  }
  const fs::path file = *folder_->layer("error");
  requireOwnGrid(file);
  const io::Layer<float> error = io::readLayer<float>(file, part.window);
  if (error.bands.size() < 2) {
    throw InputError(fmt::format(
        "{}: has one band where errors have two, plane and height; make the map anew with "
        "agricolmap fuse",
        file.string()));
  }
  heights.plane_error = change::areaRms(error.bands[0], part.frame, grid);
  heights.height_error = change::areaRms(error.bands[1], part.frame, grid);
}

change::MapHeights ChangeMap::heightsOn(const GridFrame& grid, const Eigen::Vector3d& origin,
                                        std::vector<std::string>& warnings) const {
  const Part part = partFor(grid, origin);
  change::MapHeights heights;
  heights.surface = change::areaMean(surfaceIn(part.window, warnings), part.frame, grid);
  readErrors(part, grid, heights);
  const auto source = folder_ ? folder_->layer("source") : std::nullopt;
  if (!source) {
    heights.source = Raster<std::uint16_t>(grid.rows, grid.cols);
    return heights;
  }
  requireOwnGrid(*source);
  const io::Layer<std::uint16_t> codes = io::readLayer<std::uint16_t>(*source, part.window);
  heights.source = change::nearestCode(codes.bands.front(), part.frame, grid);
  return heights;
}

std::optional<Raster<float>> ChangeMap::layerOn(const std::string& layer, const GridFrame& grid,
                                                const Eigen::Vector3d& origin) const {
  const auto file = folder_ ? folder_->layer(layer) : std::nullopt;
  if (!file) return std::nullopt;
  requireOwnGrid(*file);
  const Part part = partFor(grid, origin);
  return change::areaMean(io::readLayer<float>(*file, part.window).bands.front(), part.frame, grid);
}

report::ColourMap ChangeMap::coloursOn(const GridFrame& grid, const Eigen::Vector3d& origin) const {
  const auto file = folder_ ? folder_->layer("colour") : std::nullopt;
  if (!file) return {};
  requireOwnGrid(*file);
  const Part part = partFor(grid, origin);
  io::Layer<Rgb> layer = io::readLayer<Rgb>(*file, part.window);
  return {part.frame, std::move(layer.bands.front()), std::move(layer.valid)};
}

CommonGround commonGroundOf(const ChangeMap& a, const ChangeMap& b,
                            std::vector<std::string>& warnings) {
  const io::LayerShape& one = a.shape();
  const io::LayerShape& other = b.shape();
  if (const auto warning =
          io::checkSameCrs(one.name, io::placeOf(one), other.name, io::placeOf(other))) {
    warnings.push_back(*warning);
  }
  CommonGround ground;
  ground.origin = one.origin;
  ground.crs = one.crs.empty() ? other.crs : one.crs;
  const auto frame = change::commonGrid(one.frame, aboutOrigin(other, ground.origin));
  if (!frame) {
    const auto extent = [](const io::LayerShape& shape) {
      return io::extentOf(io::placeOf(shape), shape.frame.rows, shape.frame.cols);
    };
    throw InputError(
        fmt::format("{} ({}) and {} ({}) do not overlap by a whole cell; compare maps of one field",
                    a.name(), extent(one), b.name(), extent(other)));
  }
  ground.frame = *frame;
  return ground;
}

}  // namespace agricolmap
