// Polygons of codes, shapefiles, and the way to longitude and latitude and back.
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {
namespace {

using test::TempDir;

double areaOf(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

TEST(CodePolygons, HangTogetherAlongSidesAndHaveHoles) {
  // Southernmost row first: a ring of 1 around a 2, a 1 that touches the ring at a corner alone.
  const std::vector<std::vector<int>> rows = {
      {1, 1, 1, 0, 0}, {1, 2, 1, 0, 0}, {1, 1, 1, 0, 0}, {0, 0, 0, 1, 2}};
  Raster<std::uint8_t> codes(4, 5);
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 5; ++c) {
      codes(r, c) =
          static_cast<std::uint8_t>(rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)]);
    }
  }
  Eigen::Affine2d place = Eigen::Affine2d::Identity();
  place.linear() << 2.0, -1.0, 1.0, 2.0;
  place.translation() << 100.0, 50.0;
  const std::vector<CodePolygon> found = codePolygons(codes, place);
  ASSERT_EQ(found.size(), 4U);
  const auto ring = std::ranges::find_if(found, [](const auto& p) { return !p.holes.empty(); });
  ASSERT_NE(ring, found.end());
  EXPECT_EQ(ring->code, 1);
  ASSERT_EQ(ring->holes.size(), 1U);
  EXPECT_NEAR(areaOf(ring->outline), 9.0 * 5.0, 1e-9);
  EXPECT_NEAR(areaOf(ring->holes.front()), 5.0, 1e-9);
  double twos = 0.0;
  for (const CodePolygon& polygon : found) twos += polygon.code == 2 ? areaOf(polygon.outline) : 0;
  EXPECT_NEAR(twos, 10.0, 1e-9);
  const Eigen::Vector2d south_west = place * Eigen::Vector2d(0.0, 0.0);
  EXPECT_TRUE(std::ranges::any_of(ring->outline, [&](const Eigen::Vector2d& corner) {
    return (corner - south_west).norm() < 1e-9;
  }));
}

TEST(CodePolygons, AreValidHoweverTheSquaresMeet) {
  Random random(7);
  Raster<std::uint8_t> codes(30, 30);
  for (std::uint8_t& code : codes) code = static_cast<std::uint8_t>(random.below(4));
  double area = 0.0;
  for (const CodePolygon& polygon : codePolygons(codes, Eigen::Affine2d::Identity())) {
    OGRPolygon shape;
    std::vector<std::vector<Eigen::Vector2d>> rings = {polygon.outline};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    for (const auto& corners : rings) {
      OGRLinearRing ring;
      for (const Eigen::Vector2d& p : corners) ring.addPoint(p.x(), p.y());
      ring.closeRings();
      shape.addRing(&ring);
    }
    EXPECT_TRUE(shape.IsValid());
    area += shape.get_Area();
  }
  EXPECT_NEAR(area, 900.0 - static_cast<double>(std::ranges::count(codes, 0)), 1e-9);
}

TEST(VectorFile, ShapefilesHaveTheirNumbersAndPlace) {
  const TempDir dir;
  VectorLayer layer{
      "rates",
      GeometryKind::kPolygon,
      {{"CLASS", FieldKind::kInteger}, {"RATE", FieldKind::kReal, 4}, {"UNIT", FieldKind::kText}},
      {}};
  VectorFeature feature{{{11.0, 48.0}, {11.1, 48.0}, {11.1, 48.1}, {11.0, 48.1}},
                        {std::int64_t{3}, 120.25, std::string("kg/ha")},
                        {{{11.02, 48.02}, {11.04, 48.02}, {11.04, 48.04}}}};
  layer.features.push_back(feature);
  writeShapefile(dir.path(), layer, geographicCrs());
  for (const char* end : {".shp", ".shx", ".dbf", ".prj"}) {
    EXPECT_TRUE(std::filesystem::exists(dir / (std::string("rates") + end))) << end;
  }
  const GDALDatasetUniquePtr file(GDALDataset::Open((dir / "rates.shp").c_str(), GDAL_OF_VECTOR));
  ASSERT_TRUE(file);
  OGRLayer& read = *file->GetLayer(0);
  ASSERT_NE(read.GetSpatialRef(), nullptr);
  EXPECT_TRUE(read.GetSpatialRef()->IsGeographic());
  const OGRFeatureUniquePtr first(read.GetNextFeature());
  EXPECT_EQ(first->GetFieldAsInteger("CLASS"), 3);
  EXPECT_DOUBLE_EQ(first->GetFieldAsDouble("RATE"), 120.25);
  EXPECT_STREQ(first->GetFieldAsString("UNIT"), "kg/ha");
  EXPECT_EQ(first->GetGeometryRef()->toPolygon()->getNumInteriorRings(), 1);
}

TEST(VectorFile, OfSquaresGivesAFieldsValues) {
  const TempDir dir;
  VectorLayer layer{"grid",
                    GeometryKind::kPolygon,
                    {{"weeds", FieldKind::kReal}, {"note", FieldKind::kText}},
                    {}};
  layer.features.push_back({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {0.25, std::string("a")}});
  layer.features.push_back({{{2, 0}, {4, 0}, {4, 2}, {2, 2}}, {std::nan(""), std::string("b")}});
  writeGeoPackage(dir / "facts.gpkg", {layer}, *crsFromWkt("EPSG:32632"));
  const ValuedPolygons read = readValues(dir / "facts.gpkg", "grid", "weeds");
  EXPECT_EQ(read.crs.name, "WGS 84 / UTM zone 32N");
  ASSERT_EQ(read.polygons.size(), 2U);
  EXPECT_EQ(read.polygons[0].value, 0.25);
  EXPECT_TRUE(std::isnan(read.polygons[1].value));
  EXPECT_EQ(read.polygons[0].corners.size(), 4U);
  try {
    readValues(dir / "facts.gpkg", "grid", "cover");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no field 'cover'; it has weeds"), std::string::npos);
  }
  EXPECT_THROW(readValues(dir / "facts.gpkg", "rows", "weeds"), InputError);
  EXPECT_THROW(readValues(dir / "none.gpkg", "grid", "weeds"), InputError);
}

TEST(VectorFile, WithoutASystemIsAPlaneThatNobodyKnows) {
  const TempDir dir;
  VectorLayer layer{"grid", GeometryKind::kPolygon, {{"weeds", FieldKind::kReal}}, {}};
  layer.features.push_back({{{5e5, 5e6}, {500002, 5e6}, {500002, 5000002}}, {0.25}});
  writeGeoPackage(dir / "ours.gpkg", {layer}, {});
  const GDALDatasetUniquePtr ours(
      GDALDataset::Open((dir / "ours.gpkg").c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE));
  const OGRSpatialReference* srs = ours->GetLayer(0)->GetSpatialRef();
  ASSERT_NE(srs, nullptr);
  EXPECT_STREQ(srs->GetName(), "Undefined Cartesian SRS");
  // As others write it, of GDAL 3.6 degrees without a name.
  OGRLayer* theirs = ours->CreateLayer("theirs", nullptr, wkbPolygon, nullptr);
  OGRFieldDefn field("weeds", OFTReal);
  theirs->CreateField(&field);
  const OGRFeatureUniquePtr feature(OGRFeature::CreateFeature(theirs->GetLayerDefn()));
  feature->SetGeometry(OGRFeatureUniquePtr(ours->GetLayer(0)->GetNextFeature())->GetGeometryRef());
  ASSERT_EQ(theirs->CreateFeature(feature.get()), OGRERR_NONE);
  ours->FlushCache();
  for (const char* name : {"grid", "theirs"}) {
    EXPECT_EQ(readValues(dir / "ours.gpkg", name, "weeds").crs.wkt, "") << name;
  }
  const auto read = readPolygons(dir / "ours.gpkg", *crsFromWkt("EPSG:32632"));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(read[0].corners[1], Eigen::Vector2d(500002, 5e6));
}

TEST(VectorFile, StylesLieWhereQgisLooksForThem) {
  const TempDir dir;
  VectorLayer styled{"plants", GeometryKind::kPoint, {}, {{{{1.0, 2.0}}, {}}}, "<qgis>'a'</qgis>"};
  const VectorLayer plain{"weeds", GeometryKind::kPoint, {}, {{{{3.0, 4.0}}, {}}}};
  writeGeoPackage(dir / "plain.gpkg", {plain}, {});
  writeGeoPackage(dir / "styled.gpkg", {plain, styled}, {});
  const auto open = [&](const char* name) {
    return GDALDatasetUniquePtr(GDALDataset::Open((dir / name).c_str(), GDAL_OF_VECTOR));
  };
  EXPECT_EQ(open("plain.gpkg")->GetLayerByName("layer_styles"), nullptr);
  const GDALDatasetUniquePtr file = open("styled.gpkg");
  OGRLayer* table = file->GetLayerByName("layer_styles");
  ASSERT_NE(table, nullptr);
  ASSERT_EQ(table->GetFeatureCount(), 1);
  // As QGIS asks for it.
  table->SetAttributeFilter(
      "f_table_schema = '' AND f_table_name = 'plants' AND f_geometry_column = 'geom'");
  const OGRFeatureUniquePtr row(table->GetNextFeature());
  ASSERT_TRUE(row);
  EXPECT_STREQ(row->GetFieldAsString("styleQML"), "<qgis>'a'</qgis>");
  EXPECT_EQ(row->GetFieldAsInteger("useAsDefault"), 1);
}

TEST(Geographic, ThereAndBackIsTheSamePlace) {
  const Crs utm = *crsFromWkt("EPSG:32632");
  const std::vector<Eigen::Vector2d> points = {{500000.0, 5300000.0}, {612345.6, 5432100.1}};
  const auto degrees = geographic(utm, points);
  ASSERT_TRUE(degrees);
  EXPECT_NEAR((*degrees)[0].x(), 9.0, 1e-9);
  const auto back = fromGeographic(utm, *degrees);
  ASSERT_TRUE(back);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(((*back)[i] - points[i]).norm(), 1e-4);
  EXPECT_FALSE(fromGeographic({}, points));
}

}  // namespace
}  // namespace agricolmap::io
