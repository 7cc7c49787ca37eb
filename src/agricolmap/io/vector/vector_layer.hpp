// Things on a map with what is known of them: points, lines and polygons, written as GeoPackage,
// GeoJSON and CSV, and polygons read from whatever OGR reads.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "agricolmap/core/cloud.hpp"
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
  std::vector<VectorValue> values;  ///< as the layer's fields
};

struct VectorLayer {
  std::string name;
  GeometryKind kind = GeometryKind::kPoint;
  std::vector<VectorField> fields;
  std::vector<VectorFeature> features;
};

/// All layers in one file. `crs` may be empty. Throws OutputError with GDAL's reason, UsageError
/// where this build has no GDAL.
void writeGeoPackage(const OutputPath& path, const std::vector<VectorLayer>& layers,
                     const Crs& crs);

/// A table: the fields, points with their x and y before them.
void writeCsv(const OutputPath& path, const VectorLayer& layer);

/// Coordinates as longitude and latitude (WGS 84), as GeoJSON has them; nothing where `crs` is
/// empty or GDAL is not built in.
std::optional<std::vector<Eigen::Vector2d>> geographic(const Crs& crs,
                                                       const std::vector<Eigen::Vector2d>& points);

/// A polygon of a file; of one with holes its outer ring.
struct NamedPolygon {
  std::string id;
  std::vector<Eigen::Vector2d> corners;  ///< not closed
};

/// The polygons of the file's first layer that has some, brought to `crs` where both are known.
/// They are called by their field `id`, `plot_id`, `plot`, `name` or `observationUnitName`, else by
/// their number. Parts of one have its name and a number. Throws InputError when the file cannot be
/// read or has no polygon, UsageError where this build has no GDAL.
std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& crs);

}  // namespace agricolmap::io
