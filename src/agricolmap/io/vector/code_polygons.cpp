#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <array>
#include <cstdint>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/vector/ogr_support.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void fail() {
  throw OutputError(std::string("GDAL cannot make polygons of the squares: ") +
                    CPLGetLastErrorMsg());
}

std::vector<Eigen::Vector2d> cornersOf(const OGRLinearRing& ring) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i + 1 < ring.getNumPoints(); ++i) {
    corners.emplace_back(ring.getX(i), ring.getY(i));
  }
  return corners;
}

void add(const OGRPolygon& polygon, int code, std::vector<CodePolygon>& found) {
  CodePolygon& result = found.emplace_back();
  result.code = code;
  result.outline = cornersOf(*polygon.getExteriorRing());
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i) {
    result.holes.push_back(cornersOf(*polygon.getInteriorRing(i)));
  }
}

}  // namespace

std::vector<CodePolygon> codePolygons(const Raster<std::uint8_t>& codes,
                                      const Eigen::Affine2d& plane_from_cell) {
  const QuietGdal quiet;
  registerDrivers();
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const GDALDatasetUniquePtr raster(
      drivers.GetDriverByName("MEM")->Create("", codes.cols(), codes.rows(), 1, GDT_Byte, nullptr));
  const GDALDatasetUniquePtr shapes(
      drivers.GetDriverByName("Memory")->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  if (!raster || !shapes) fail();
  const Eigen::Matrix2d& linear = plane_from_cell.linear();
  const Eigen::Vector2d& corner = plane_from_cell.translation();
  std::array<double, 6> place{corner.x(), linear(0, 0), linear(0, 1),
                              corner.y(), linear(1, 0), linear(1, 1)};
  raster->SetGeoTransform(place.data());
  GDALRasterBand& band = *raster->GetRasterBand(1);
  auto* const cells = const_cast<std::uint8_t*>(codes.data());  // which GDAL reads alone
  if (band.RasterIO(GF_Write, 0, 0, codes.cols(), codes.rows(), cells, codes.cols(), codes.rows(),
                    GDT_Byte, 0, 0, nullptr) != CE_None) {
    fail();
  }
  OGRLayer* const layer = shapes->CreateLayer("codes", nullptr, wkbPolygon, nullptr);
  OGRFieldDefn field("code", OFTInteger);
  if (layer == nullptr || layer->CreateField(&field) != OGRERR_NONE) fail();
  // The band masks itself: where it is 0 there are no polygons.
  if (GDALPolygonize(&band, &band, layer, 0, nullptr, nullptr, nullptr) != CE_None) fail();
  std::vector<CodePolygon> found;
  for (const OGRFeatureUniquePtr& feature : layer) {
    add(*feature->GetGeometryRef()->toPolygon(), feature->GetFieldAsInteger(0), found);
  }
  return found;
}

}  // namespace agricolmap::io
