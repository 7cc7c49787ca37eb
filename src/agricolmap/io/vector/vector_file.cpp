#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/vector/ogr_support.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {

namespace {

[[noreturn]] void failWrite(const OutputPath& path, std::string_view what) {
  const std::string reason = CPLGetLastErrorMsg();
  throw OutputError(
      fmt::format("{}: {}{}{}", path.shown(), what, reason.empty() ? "" : ": ", reason));
}

OGRwkbGeometryType typeOf(GeometryKind kind) {
  switch (kind) {
    case GeometryKind::kPoint:
      return wkbPoint;
    case GeometryKind::kLine:
      return wkbLineString;
    case GeometryKind::kPolygon:
      return wkbPolygon;
  }
  return wkbUnknown;
}

void addRing(OGRPolygon& polygon, const std::vector<Eigen::Vector2d>& points) {
  OGRLinearRing ring;
  for (const Eigen::Vector2d& p : points) ring.addPoint(p.x(), p.y());
  ring.closeRings();
  polygon.addRing(&ring);
}

std::unique_ptr<OGRGeometry> geometryOf(GeometryKind kind, const VectorFeature& feature) {
  const std::vector<Eigen::Vector2d>& points = feature.points;
  if (kind == GeometryKind::kPoint) {
    return std::make_unique<OGRPoint>(points.front().x(), points.front().y());
  }
  if (kind == GeometryKind::kLine) {
    auto line = std::make_unique<OGRLineString>();
    for (const Eigen::Vector2d& p : points) line->addPoint(p.x(), p.y());
    return line;
  }
  auto polygon = std::make_unique<OGRPolygon>();
  addRing(*polygon, points);
  for (const std::vector<Eigen::Vector2d>& hole : feature.holes) addRing(*polygon, hole);
  return polygon;
}

OGRFieldType fieldTypeOf(FieldKind kind) {
  switch (kind) {
    case FieldKind::kInteger:
      return OFTInteger64;
    case FieldKind::kReal:
      return OFTReal;
    case FieldKind::kText:
      return OFTString;
  }
  return OFTString;
}

void fillFeature(OGRFeature& feature, const VectorLayer& layer, const VectorFeature& from) {
  for (std::size_t k = 0; k < layer.fields.size(); ++k) {
    const int field = static_cast<int>(k);
    const VectorValue& value = from.values[k];
    if (const auto* number = std::get_if<std::int64_t>(&value)) {
      feature.SetField(field, static_cast<GIntBig>(*number));
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      feature.SetField(field, text->c_str());
    } else if (const auto* real = std::get_if<double>(&value); real && std::isfinite(*real)) {
      feature.SetField(field, *real);
    }
  }
  feature.SetGeometryDirectly(geometryOf(layer.kind, from).release());
}

/// Tables of shapefiles have columns of so many letters, and else ones of 24 with 15 decimals.
void fitColumn(const VectorField& field, OGRFieldDefn& definition) {
  constexpr int kNumberWidth = 18;
  constexpr int kTextWidth = 64;
  definition.SetWidth(field.kind == FieldKind::kText ? kTextWidth : kNumberWidth);
  if (field.kind == FieldKind::kReal) definition.SetPrecision(field.decimals);
  // A wider one is read as a number with decimals by some.
  if (field.kind == FieldKind::kInteger) {
    definition.SetType(OFTInteger);
    definition.SetWidth(9);
  }
}

void writeLayer(GDALDataset& file, const VectorLayer& layer, OGRSpatialReference* srs,
                const OutputPath& path, bool fit_columns = false) {
  OGRLayer* written = file.CreateLayer(layer.name.c_str(), srs, typeOf(layer.kind), nullptr);
  if (written == nullptr) failWrite(path, "the layer " + layer.name + " cannot be made");
  for (const VectorField& field : layer.fields) {
    OGRFieldDefn definition(field.name.c_str(), fieldTypeOf(field.kind));
    if (fit_columns) fitColumn(field, definition);
    if (written->CreateField(&definition) != OGRERR_NONE) {
      failWrite(path, "the field " + field.name + " cannot be made");
    }
  }
  for (const VectorFeature& from : layer.features) {
    OGRFeature feature(written->GetLayerDefn());
    fillFeature(feature, layer, from);
    if (written->CreateFeature(&feature) != OGRERR_NONE) {
      failWrite(path, "a feature of " + layer.name + " cannot be written");
    }
  }
}

/// The table in which QGIS keeps styles: it takes a layer's default from there when it opens it.
void writeStyles(GDALDataset& file, const std::vector<VectorLayer>& layers,
                 const OutputPath& path) {
  if (std::ranges::all_of(layers, &std::string::empty, &VectorLayer::qgis_style)) return;
  const char* const options[] = {"FID=id", nullptr};
  OGRLayer* table = file.CreateLayer("layer_styles", nullptr, wkbNone, const_cast<char**>(options));
  if (table == nullptr) failWrite(path, "the layer layer_styles cannot be made");
  for (const char* name :
       {"f_table_catalog", "f_table_schema", "f_table_name", "f_geometry_column", "styleName",
        "styleQML", "styleSLD", "useAsDefault", "description", "owner", "ui", "update_time"}) {
    const std::string_view word(name);
    OGRFieldDefn field(name, word == "update_time" ? OFTDateTime : OFTString);
    if (word == "useAsDefault") {
      field.SetType(OFTInteger);
      field.SetSubType(OFSTBoolean);
    }
    if (table->CreateField(&field) != OGRERR_NONE) failWrite(path, "layer_styles cannot be made");
  }
  for (const VectorLayer& layer : layers) {
    if (layer.qgis_style.empty()) continue;
    OGRLayer& styled = *file.GetLayerByName(layer.name.c_str());
    OGRFeature row(table->GetLayerDefn());
    // QGIS looks for a schema that is empty, not for one that is missing.
    for (const char* name : {"f_table_catalog", "f_table_schema", "description", "owner", "ui"}) {
      row.SetField(name, "");
    }
    row.SetField("f_table_name", layer.name.c_str());
    row.SetField("f_geometry_column", styled.GetGeometryColumn());
    row.SetField("styleName", layer.name.c_str());
    row.SetField("styleQML", layer.qgis_style.c_str());
    row.SetField("useAsDefault", 1);
    if (table->CreateFeature(&row) != OGRERR_NONE) failWrite(path, "a style cannot be written");
  }
}

}  // namespace

void writeGeoPackage(const OutputPath& path, const std::vector<VectorLayer>& layers,
                     const Crs& crs) {
  const QuietGdal quiet;
  registerDrivers();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) {
    throw OutputError(
        fmt::format("{}: this GDAL writes no GeoPackage; install it with SQLite", path.shown()));
  }
  OGRSpatialReference srs = horizontalSrs(crs).value_or(unknownPlane());
  CPLErrorReset();
  GDALDatasetUniquePtr file(driver->Create(path.file().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file) failWrite(path, "cannot be made");
  for (const VectorLayer& layer : layers) {
    const bool whole = file->StartTransaction() == OGRERR_NONE;
    writeLayer(*file, layer, &srs, path);
    if (whole && file->CommitTransaction() != OGRERR_NONE) failWrite(path, "cannot be written");
  }
  writeStyles(*file, layers, path);
  CPLErrorReset();
  file.reset();
  if (CPLGetLastErrorType() == CE_Failure) failWrite(path, "cannot be written");
}

void writeShapefile(const OutputPath& dir, const VectorLayer& layer, const Crs& crs) {
  const QuietGdal quiet;
  registerDrivers();
  const OutputPath path = dir / (layer.name + ".shp");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("ESRI Shapefile");
  if (driver == nullptr) {
    throw OutputError(fmt::format("{}: this GDAL writes no shapefile", path.shown()));
  }
  std::optional<OGRSpatialReference> srs = horizontalSrs(crs);
  CPLErrorReset();
  GDALDatasetUniquePtr file(driver->Create(path.file().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file) failWrite(path, "cannot be made");
  writeLayer(*file, layer, srs ? &*srs : nullptr, path, true);
  CPLErrorReset();
  file.reset();
  if (CPLGetLastErrorType() == CE_Failure) failWrite(path, "cannot be written");
}

}  // namespace agricolmap::io
