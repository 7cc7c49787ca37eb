#include <cpl_error.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>

#include <array>
#include <limits>
#include <memory>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/vector/ogr_support.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {
namespace {

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

GDALDatasetUniquePtr openVector(const std::filesystem::path& path) {
  registerDrivers();
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(fmt::format("{}: there is no such file", name));
  }
  CPLErrorReset();
  GDALDatasetUniquePtr file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!file) {
    throw InputError(fmt::format(
        "{}: cannot be read as a map of polygons; give a GeoPackage, GeoJSON or shapefile", name));
  }
  return file;
}

std::string numberFields(OGRLayer& layer) {
  std::string names;
  const OGRFeatureDefn& definition = *layer.GetLayerDefn();
  for (int i = 0; i < definition.GetFieldCount(); ++i) {
    if (definition.GetFieldDefn(i)->GetType() == OFTString) continue;
    names += (names.empty() ? "" : ", ") + std::string(definition.GetFieldDefn(i)->GetNameRef());
  }
  return names;
}

}  // namespace

ValuedPolygons readValues(const std::filesystem::path& path, const std::string& layer,
                          const std::string& field) {
  const QuietGdal quiet;
  const GDALDatasetUniquePtr file = openVector(path);
  OGRLayer* const from = file->GetLayerByName(layer.c_str());
  if (from == nullptr) {
    throw InputError(fmt::format("{}: has no layer {}", path.string(), layer));
  }
  const int index = from->GetLayerDefn()->GetFieldIndex(field.c_str());
  if (index < 0) {
    throw InputError(fmt::format("{}: its layer {} has no field '{}'; it has {}", path.string(),
                                 layer, field, numberFields(*from)));
  }
  ValuedPolygons result;
  if (const OGRSpatialReference* srs = srsOf(*from); srs != nullptr) {
    result.crs = crsFrom(*srs);
  }
  for (const OGRFeatureUniquePtr& feature : *from) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    std::vector<NamedPolygon> parts;
    addPolygons(*geometry, "", parts);
    const double value = feature->IsFieldSetAndNotNull(index)
                             ? feature->GetFieldAsDouble(index)
                             : std::numeric_limits<double>::quiet_NaN();
    for (NamedPolygon& part : parts) result.polygons.push_back({std::move(part.corners), value});
  }
  return result;
}

std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& crs) {
  const QuietGdal quiet;
  const std::string name = path.string();
  const GDALDatasetUniquePtr file = openVector(path);
  const std::optional<OGRSpatialReference> to = horizontalSrs(crs);
  std::vector<NamedPolygon> found;
  for (int k = 0; k < file->GetLayerCount() && found.empty(); ++k) {
    OGRLayer& layer = *file->GetLayer(k);
    std::unique_ptr<OGRCoordinateTransformation> transform;
    if (const OGRSpatialReference* from = srsOf(layer); from != nullptr && to) {
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
