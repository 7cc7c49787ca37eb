// Small rasters for tests, written through GDAL.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/error.hpp"

namespace agricolmap::test {

/// What to put into a small raster. Values by (band from 0, col, row).
struct Sheet {
  int cols = 8;
  int rows = 6;
  int bands = 3;
  GDALDataType type = GDT_Byte;
  std::array<double, 6> place{500000.0, 0.5, 0.0, 5000000.0, 0.0, -0.5};
  int epsg = 32632;  ///< 0: none
  std::optional<double> nodata = {};
  bool alpha = false;  ///< the last band is alpha
  std::function<double(int, int, int)> value = [](int band, int col, int row) {
    return 10.0 * (band + 1) + col + row;
  };
  std::string driver = "GTiff";
  bool georeferenced = true;
  std::string crs = {};                 ///< instead of `epsg`, as EPSG:32618+6360
  std::string unit = {};                ///< of all bands
  std::vector<std::string> names = {};  ///< of the bands
  const char* compress = "NONE";        ///< of GeoTIFF
  bool undeclared = false;              ///< nothing is said of what the bands are
};

/// Heights that rise with the columns and, less, with the rows.
inline Sheet surfaceModel() {
  Sheet sheet;
  sheet.bands = 1;
  sheet.type = GDT_Float32;
  sheet.value = [](int, int col, int row) { return 300.0 + 0.25 * col + 0.1 * row; };
  return sheet;
}

inline std::filesystem::path writeSheet(const std::filesystem::path& path, const Sheet& sheet) {
  GDALAllRegister();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName(sheet.driver.c_str());
  const std::string compress = std::string("COMPRESS=") + sheet.compress;
  const char* const options[] = {compress.c_str(), nullptr};
  const bool tiff = sheet.driver == "GTiff";
  const GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), sheet.cols, sheet.rows,
                                                    sheet.bands, sheet.type,
                                                    tiff ? const_cast<char**>(options) : nullptr));
  if (!dataset) throw OutputError("GDAL cannot write " + path.string());
  if (sheet.georeferenced) {
    std::array<double, 6> place = sheet.place;
    dataset->SetGeoTransform(place.data());
  }
  if (sheet.epsg != 0) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(
        (sheet.crs.empty() ? "EPSG:" + std::to_string(sheet.epsg) : sheet.crs).c_str());
    dataset->SetSpatialRef(&crs);
  }
  for (int b = 0; b < sheet.bands; ++b) {
    GDALRasterBand* const band = dataset->GetRasterBand(b + 1);
    const auto at = static_cast<std::size_t>(b);
    if (!sheet.unit.empty()) band->SetUnitType(sheet.unit.c_str());
    if (at < sheet.names.size()) band->SetDescription(sheet.names[at].c_str());
    if (sheet.undeclared) band->SetColorInterpretation(GCI_Undefined);
    if (sheet.nodata) band->SetNoDataValue(*sheet.nodata);
    if (sheet.alpha && b == sheet.bands - 1) band->SetColorInterpretation(GCI_AlphaBand);
    std::vector<double> line(static_cast<std::size_t>(sheet.cols));
    for (int row = 0; row < sheet.rows; ++row) {
      for (int col = 0; col < sheet.cols; ++col) {
        line[static_cast<std::size_t>(col)] = sheet.value(b, col, row);
      }
      if (band->RasterIO(GF_Write, 0, row, sheet.cols, 1, line.data(), sheet.cols, 1, GDT_Float64,
                         0, 0, nullptr) != CE_None) {
        throw OutputError("GDAL cannot write " + path.string());
      }
    }
  }
  return path;
}

}  // namespace agricolmap::test
