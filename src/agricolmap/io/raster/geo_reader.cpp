#include "agricolmap/io/raster/geo_reader.hpp"

#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/raster/raster_dataset.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap::io {
namespace {

/// Of the side of a cell: what sides may differ by, and how far a raster may be turned.
constexpr double kSquareTolerance = 1e-6;
constexpr int kStripRows = 512;

template <typename T>
constexpr GDALDataType kTypeOf = std::is_same_v<T, float>           ? GDT_Float32
                                 : std::is_same_v<T, std::uint16_t> ? GDT_UInt16
                                 : std::is_same_v<T, std::int32_t>  ? GDT_Int32
                                                                    : GDT_Byte;

double cellOf(const std::string& name, const Eigen::Affine2d& world_from_pixel) {
  const Eigen::Matrix2d& m = world_from_pixel.linear();
  const double cell = m(0, 0);
  const double off = std::max({std::abs(m(0, 1)), std::abs(m(1, 0)), std::abs(m(1, 1) + cell)});
  if (cell > 0.0 && off <= kSquareTolerance * cell) return cell;
  throw InputError(
      fmt::format("{}: its cells are not square or not north up ({:.9g} by {:.9g}); bring it "
                  "onto such a grid with gdalwarp -tr CELL CELL",
                  name, m.col(0).norm(), m.col(1).norm()));
}

LayerShape shapeOf(GDALDataset& dataset, const std::string& name) {
  const RasterPlace place = placeOf(dataset);
  checkGeoreference(name, place);
  LayerShape shape;
  shape.name = name;
  shape.crs = place.crs;
  GridFrame& frame = shape.frame;
  frame.cell = cellOf(name, *place.world_from_pixel);
  frame.rows = dataset.GetRasterYSize();
  frame.cols = dataset.GetRasterXSize();
  const Eigen::Vector2d corner =
      place.world_from_pixel->translation() - Eigen::Vector2d(0.0, frame.rows * frame.cell);
  shape.origin.head<2>() = corner.array().floor();
  frame.corner = corner - shape.origin.head<2>();
  for (int b = 1; b <= dataset.GetRasterCount(); ++b) {
    GDALRasterBand& band = *dataset.GetRasterBand(b);
    shape.bands.emplace_back(band.GetDescription());
    shape.units.emplace_back(band.GetUnitType());
  }
  char** const items = dataset.GetMetadata();
  for (int i = 0; i < CSLCount(items); ++i) {
    char* key = nullptr;
    const char* const value = CPLParseNameValue(items[i], &key);
    if (key != nullptr && value != nullptr) shape.metadata[key] = value;
    CPLFree(key);
  }
  return shape;
}

CellWindow checkedWindow(const LayerShape& shape, const std::optional<CellWindow>& asked) {
  const GridFrame& frame = shape.frame;
  const CellWindow window = asked.value_or(CellWindow{0, 0, frame.rows, frame.cols});
  if (window.row < 0 || window.col < 0 || window.rows < 1 || window.cols < 1 ||
      window.rows > frame.rows - window.row || window.cols > frame.cols - window.col) {
    throw InputError(fmt::format(
        "{}: the window of {} x {} cells at column {}, row {} is not within its {} x {} cells",
        shape.name, window.cols, window.rows, window.col, window.row, frame.cols, frame.rows));
  }
  if (1.0 * window.rows * window.cols > kMaxPixels) {
    throw InputError(fmt::format(
        "{}: {} x {} cells are too many (limit {:.0e}); crop it with gdalwarp -te or thin it with "
        "gdal_translate -outsize",
        shape.name, window.cols, window.rows, kMaxPixels));
  }
  return window;
}

/// Reads a window of a band, `spacing` bytes from cell to cell, southernmost row first.
void readCells(GDALRasterBand& band, const CellWindow& window, GDALDataType type, void* out,
               std::size_t spacing, const std::string& name) {
  const auto line = static_cast<std::ptrdiff_t>(spacing) * window.cols;
  const int top = band.GetYSize() - window.row - window.rows;
  for (int done = 0; done < window.rows; done += kStripRows) {
    throwIfInterrupted();
    const int count = std::min(kStripRows, window.rows - done);
    // The file's first row goes to the end, and each further one before it.
    auto* const to = static_cast<std::byte*>(out) + line * (window.rows - 1 - done);
    if (band.RasterIO(GF_Read, window.col, top + done, window.cols, count, to, window.cols, count,
                      type, static_cast<GSpacing>(spacing), -line, nullptr) != CE_None) {
      failRaster(name, fmt::format("damaged or truncated at row {}", top + done));
    }
  }
}

void requireType(GDALRasterBand& band, GDALDataType type, const std::string& name) {
  const GDALDataType own = band.GetRasterDataType();
  const bool fits =
      type == GDT_Float32 ? GDALDataTypeIsComplex(own) == 0 : GDALDataTypeUnion(own, type) == type;
  if (fits) return;
  throw InputError(fmt::format("{}: its values are {}, where {} is needed", name,
                               GDALGetDataTypeName(own), GDALGetDataTypeName(type)));
}

void emptyNodata(GDALRasterBand& band, Raster<float>& values) {
  int has_nodata = 0;
  const auto nodata = static_cast<float>(band.GetNoDataValue(&has_nodata));
  for (float& value : values) {
    if (!std::isfinite(value) || (has_nodata != 0 && value == nodata)) {
      value = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

template <typename T>
void readBands(GDALDataset& dataset, const CellWindow& window, Layer<T>& layer) {
  const std::string& name = layer.shape.name;
  for (int b = 1; b <= dataset.GetRasterCount(); ++b) {
    GDALRasterBand& band = *dataset.GetRasterBand(b);
    requireType(band, kTypeOf<T>, name);
    Raster<T>& values = layer.bands.emplace_back(window.rows, window.cols);
    readCells(band, window, kTypeOf<T>, values.data(), sizeof(T), name);
    if constexpr (std::is_same_v<T, float>) emptyNodata(band, values);
  }
}

template <>
void readBands(GDALDataset& dataset, const CellWindow& window, Layer<Rgb>& layer) {
  const std::string& name = layer.shape.name;
  if (dataset.GetRasterCount() < 3) {
    throw InputError(
        fmt::format("{}: has {} bands, and colours are three", name, dataset.GetRasterCount()));
  }
  Raster<Rgb>& values = layer.bands.emplace_back(window.rows, window.cols);
  auto* const first = reinterpret_cast<std::byte*>(values.data());
  for (int b = 1; b <= 3; ++b) {
    GDALRasterBand& band = *dataset.GetRasterBand(b);
    requireType(band, GDT_Byte, name);
    readCells(band, window, GDT_Byte, first + (b - 1), sizeof(Rgb), name);
  }
}

}  // namespace

LayerShape readLayerShape(const std::filesystem::path& path) {
  const QuietGdal quiet;
  return shapeOf(*openRaster(path), path.string());
}

template <typename T>
Layer<T> readLayer(const std::filesystem::path& path, const std::optional<CellWindow>& window) {
  const QuietGdal quiet;
  const GDALDatasetUniquePtr dataset = openRaster(path);
  Layer<T> layer;
  layer.shape = shapeOf(*dataset, path.string());
  const CellWindow cells = checkedWindow(layer.shape, window);
  readBands(*dataset, cells, layer);
  layer.valid = Raster<std::uint8_t>(cells.rows, cells.cols);
  readCells(*dataset->GetRasterBand(1)->GetMaskBand(), cells, GDT_Byte, layer.valid.data(), 1,
            layer.shape.name);
  for (std::uint8_t& value : layer.valid) value = value != 0 ? 1 : 0;
  GridFrame& frame = layer.shape.frame;
  frame.corner += frame.cell * Eigen::Vector2d(cells.col, cells.row);
  frame.rows = cells.rows;
  frame.cols = cells.cols;
  return layer;
}

template Layer<float> readLayer(const std::filesystem::path&, const std::optional<CellWindow>&);
template Layer<std::uint8_t> readLayer(const std::filesystem::path&,
                                       const std::optional<CellWindow>&);
template Layer<std::uint16_t> readLayer(const std::filesystem::path&,
                                        const std::optional<CellWindow>&);
template Layer<std::int32_t> readLayer(const std::filesystem::path&,
                                       const std::optional<CellWindow>&);
template Layer<Rgb> readLayer(const std::filesystem::path&, const std::optional<CellWindow>&);

}  // namespace agricolmap::io
