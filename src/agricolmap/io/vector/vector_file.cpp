#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {

namespace {

void registerDrivers() {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
}

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

std::unique_ptr<OGRGeometry> geometryOf(GeometryKind kind,
                                        const std::vector<Eigen::Vector2d>& points) {
  if (kind == GeometryKind::kPoint) {
    return std::make_unique<OGRPoint>(points.front().x(), points.front().y());
  }
  if (kind == GeometryKind::kLine) {
    auto line = std::make_unique<OGRLineString>();
    for (const Eigen::Vector2d& p : points) line->addPoint(p.x(), p.y());
    return line;
  }
  OGRLinearRing ring;
  for (const Eigen::Vector2d& p : points) ring.addPoint(p.x(), p.y());
  ring.closeRings();
  auto polygon = std::make_unique<OGRPolygon>();
  polygon->addRing(&ring);
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
  feature.SetGeometryDirectly(geometryOf(layer.kind, from.points).release());
}

void writeLayer(GDALDataset& file, const VectorLayer& layer, OGRSpatialReference* srs,
                const OutputPath& path) {
  // Without a coordinate system of the earth, GeoPackage's own word for an unknown plane.
  OGRLayer* written = file.CreateLayer(layer.name.c_str(), srs, typeOf(layer.kind), nullptr);
  if (written == nullptr) failWrite(path, "the layer " + layer.name + " cannot be made");
  for (const VectorField& field : layer.fields) {
    OGRFieldDefn definition(field.name.c_str(), fieldTypeOf(field.kind));
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

std::optional<OGRSpatialReference> horizontalSrs(const Crs& crs) {
  if (crs.wkt.empty()) return std::nullopt;
  std::optional<OGRSpatialReference> srs = srsFrom(crs.wkt);
  if (!srs) return std::nullopt;
  OGRSpatialReference horizontal = horizontalOf(*srs);
  horizontal.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return horizontal;
}

std::string idOf(const OGRFeature& feature) {
  constexpr std::array<const char*, 5> kNames = {"id", "plot_id", "plot", "name",
                                                 "observationUnitName"};
  for (const char* name : kNames) {
    const int index = feature.GetDefnRef()->GetFieldIndex(name);
    if (index >= 0 && feature.IsFieldSetAndNotNull(index)) return feature.GetFieldAsString(index);
  }
  return fmt::format("{}", feature.GetFID());
}

void addRing(const OGRPolygon& polygon, const std::string& id, std::vector<NamedPolygon>& found) {
  const OGRLinearRing* ring = polygon.getExteriorRing();
  if (ring == nullptr) return;
  NamedPolygon result{id, {}};
  for (int i = 0; i + 1 < ring->getNumPoints(); ++i) {
    result.corners.emplace_back(ring->getX(i), ring->getY(i));
  }
  if (result.corners.size() >= 3) found.push_back(std::move(result));
}

void addPolygons(const OGRGeometry& geometry, const std::string& id,
                 std::vector<NamedPolygon>& found) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPolygon) {
    addRing(*geometry.toPolygon(), id, found);
  } else if (type == wkbMultiPolygon) {
    const OGRMultiPolygon& parts = *geometry.toMultiPolygon();
    for (int i = 0; i < parts.getNumGeometries(); ++i) {
      addRing(*parts.getGeometryRef(i),
              parts.getNumGeometries() == 1 ? id : fmt::format("{}_{}", id, i + 1), found);
    }
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
  std::optional<OGRSpatialReference> srs = horizontalSrs(crs);
  CPLErrorReset();
  GDALDatasetUniquePtr file(driver->Create(path.file().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file) failWrite(path, "cannot be made");
  for (const VectorLayer& layer : layers) {
    const bool whole = file->StartTransaction() == OGRERR_NONE;
    writeLayer(*file, layer, srs ? &*srs : nullptr, path);
    if (whole && file->CommitTransaction() != OGRERR_NONE) failWrite(path, "cannot be written");
  }
  CPLErrorReset();
  file.reset();
  if (CPLGetLastErrorType() == CE_Failure) failWrite(path, "cannot be written");
}

std::optional<std::vector<Eigen::Vector2d>> geographic(const Crs& crs,
                                                       const std::vector<Eigen::Vector2d>& points) {
  const QuietGdal quiet;
  const std::optional<OGRSpatialReference> from = horizontalSrs(crs);
  if (!from) return std::nullopt;
  OGRSpatialReference to;
  to.importFromEPSG(4326);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&*from, &to));
  if (!transform) return std::nullopt;
  std::vector<Eigen::Vector2d> result = points;
  for (Eigen::Vector2d& point : result) {
    if (transform->Transform(1, &point.x(), &point.y()) == FALSE) return std::nullopt;
  }
  return result;
}

std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& crs) {
  const QuietGdal quiet;
  registerDrivers();
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(fmt::format("{}: there is no such file", name));
  }
  CPLErrorReset();
  const GDALDatasetUniquePtr file(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!file) {
    throw InputError(fmt::format(
        "{}: cannot be read as a map of polygons; give a GeoPackage, GeoJSON or shapefile", name));
  }
  const std::optional<OGRSpatialReference> to = horizontalSrs(crs);
  std::vector<NamedPolygon> found;
  for (int k = 0; k < file->GetLayerCount() && found.empty(); ++k) {
    OGRLayer& layer = *file->GetLayer(k);
    std::unique_ptr<OGRCoordinateTransformation> transform;
    if (const OGRSpatialReference* from = layer.GetSpatialRef(); from != nullptr && to) {
      OGRSpatialReference source = *from;
      source.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      transform.reset(OGRCreateCoordinateTransformation(&source, &*to));
    }
    layer.ResetReading();
    while (const OGRFeatureUniquePtr feature{layer.GetNextFeature()}) {
      OGRGeometry* geometry = feature->GetGeometryRef();
      if (geometry == nullptr) continue;
      if (transform && geometry->transform(transform.get()) != OGRERR_NONE) {
        throw InputError(fmt::format("{}: a polygon cannot be brought into {}", name, crs.name));
      }
      addPolygons(*geometry, idOf(*feature), found);
    }
  }
  if (found.empty()) throw InputError(fmt::format("{}: has no polygon", name));
  return found;
}

}  // namespace agricolmap::io
