// Things on a map with what is known of them: points, lines and polygons, written as GeoPackage,
// shapefile and CSV, and polygons read from whatever OGR reads.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

enum class GeometryKind { kPoint, kLine, kPolygon };
enum class FieldKind { kInteger, kReal, kText };

struct VectorField {
  std::string name;  ///< with its unit: length_m
  FieldKind kind = FieldKind::kReal;
  int decimals = 3;  ///< in text files, of reals
};

/// Nothing, or a value of the field's kind; a real that is not finite is nothing.
using VectorValue = std::variant<std::monostate, std::int64_t, double, std::string>;

struct VectorFeature {
  /// One of a point; the ring of a polygon is closed by whoever writes it. File coordinates.
  std::vector<Eigen::Vector2d> points;
  std::vector<VectorValue> values;                       ///< as the layer's fields
  std::vector<std::vector<Eigen::Vector2d>> holes = {};  ///< of a polygon
};

struct VectorLayer {
  std::string name;
  GeometryKind kind = GeometryKind::kPoint;
  std::vector<VectorField> fields;
  std::vector<VectorFeature> features;
  std::string qgis_style = {};  ///< how QGIS is to draw it, as QML; GeoPackages keep it
};

/// All layers in one file, with the table `layer_styles` where QGIS looks for their styles. `crs`
/// may be empty. Throws OutputError with GDAL's reason, UsageError where this build has no GDAL.
void writeGeoPackage(const OutputPath& path, const std::vector<VectorLayer>& layers,
                     const Crs& crs);

/// One layer as `<name>.shp` with the files that belong to it, in the folder `dir`; `.prj` says the
/// coordinate system. Names of fields have ten letters at most. Throws as writeGeoPackage.
void writeShapefile(const OutputPath& dir, const VectorLayer& layer, const Crs& crs);

/// A table: the fields, points with their x and y before them.
void writeCsv(const OutputPath& path, const VectorLayer& layer);

/// Coordinates as longitude and latitude (WGS 84), as GeoJSON has them; nothing where `crs` is
/// empty or GDAL is not built in.
std::optional<std::vector<Eigen::Vector2d>> geographic(const Crs& crs,
                                                       const std::vector<Eigen::Vector2d>& points);

/// The way back, into the plane of `crs`.
std::optional<std::vector<Eigen::Vector2d>> fromGeographic(
    const Crs& crs, const std::vector<Eigen::Vector2d>& points);

/// Longitude and latitude (WGS 84) themselves; empty where GDAL is not built in.
Crs geographicCrs();

/// Cells of one code that meet along their sides, as a polygon with holes: in the coordinates that
/// `plane_from_cell` gives for (column, row), 0 at the outer corner of the first cell. Code 0 has
/// none.
struct CodePolygon {
  int code = 0;
  std::vector<Eigen::Vector2d> outline;             ///< not closed
  std::vector<std::vector<Eigen::Vector2d>> holes;  ///< the same
};
/// Throws UsageError where this build has no GDAL.
std::vector<CodePolygon> codePolygons(const Raster<std::uint8_t>& codes,
                                      const Eigen::Affine2d& plane_from_cell);

/// A polygon of a file; of one with holes its outer ring.
struct NamedPolygon {
  std::string id;
  std::vector<Eigen::Vector2d> corners;  ///< not closed
};

/// A polygon of a file with one of its numbers, NaN where that is null.
struct ValuedPolygon {
  std::vector<Eigen::Vector2d> corners;  ///< not closed, as the file has them
  double value = 0.0;
};
struct ValuedPolygons {
  Crs crs;  ///< empty where the file says none
  std::vector<ValuedPolygon> polygons;
};

/// Of the layer and the field of these names. Throws InputError when the file cannot be read or has
/// not both, with what it has; UsageError where this build has no GDAL.
ValuedPolygons readValues(const std::filesystem::path& path, const std::string& layer,
                          const std::string& field);

/// The polygons of the file's first layer that has some, brought to `crs` where both are known.
/// They are called by their field `id`, `plot_id`, `plot`, `name` or `observationUnitName`, else by
/// their number. Parts of one have its name and a number. Throws InputError when the file cannot be
/// read or has no polygon, UsageError where this build has no GDAL.
std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& crs);

}  // namespace agricolmap::io
