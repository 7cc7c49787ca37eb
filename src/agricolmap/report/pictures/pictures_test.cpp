#include "agricolmap/report/pictures/pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "agricolmap/core/convex_hull.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/deform/deform.hpp"
#include "agricolmap/report/draw/map_layer.hpp"
#include "agricolmap/report/draw/outline.hpp"
#include "agricolmap/report/draw/picture_canvas.hpp"
#include "agricolmap/report/draw/png_file.hpp"
#include "agricolmap/report/draw/test_picture.hpp"
#include "agricolmap/report/json/utf8.hpp"
#include "agricolmap/report/test_registration.hpp"

namespace agricolmap::report {
namespace {

namespace fs = std::filesystem;

using testing::Picture;
class Pictures : public testing::PictureTest {};

bool isFringe(int r, int g, int b) { return std::abs(r - g) > 90 && std::abs(r - b) < 12; }
bool isBannerRed(int r, int g, int b) { return r == 0xC6 && g == 0x28 && b == 0x28; }

/// Made once: growing the field takes longer than most tests.
const pipeline::Registration& plainRegistration() {
  static const pipeline::Registration registration = testing::testRegistration();
  return registration;
}

const PictureInfo kInfo{"field/uav/point_cloud.ply", "field/ugv_1/point_cloud.ply", {}};

TEST_F(Pictures, AllAreWrittenAndDecode) {
  const pipeline::Registration& registration = plainRegistration();
  const std::vector<std::string> names = writePictures(dir_, registration, kInfo);
  EXPECT_EQ(names.size(), 5U);
  // That of a deformation is of a registration that follows one.
  std::vector<std::string> all = names;
  all.emplace_back("deformation.png");
  EXPECT_EQ(all, pictureNames());
  for (const std::string& name : names) {
    const Picture picture(dir_ / name);
    ASSERT_TRUE(picture.ok()) << name;
    EXPECT_LE(picture.width(), 1600) << name;
    EXPECT_GT(picture.height(), 300) << name;
    EXPECT_LT(picture.height(), 1600) << name;
    EXPECT_LT(fs::file_size(dir_ / name), 4000000U) << name;
    EXPECT_EQ(picture.share(isBannerRed), 0.0) << name;
    // Nothing stands on the lower edge or is cut off by it.
    for (int y = picture.height() - 8; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) ASSERT_EQ(picture.pixel(x, y), 0xFFFFFFU) << name;
    }
    // Neither an empty page nor one flat panel.
    EXPECT_LT(picture.share([](int r, int g, int b) { return r + g + b == 3 * 255; }), 0.7) << name;
  }
}

TEST_F(Pictures, RegistrationTurnsFringesWhite) {
  writePictures(dir_, plainRegistration(), kInfo);
  const double before = Picture(dir_ / "overlay_before.png").share(isFringe);
  const double after = Picture(dir_ / "overlay_after.png").share(isFringe);
  EXPECT_GT(before, 0.05);
  EXPECT_LT(after, 0.5 * before);
}

TEST_F(Pictures, SameOnAnyNumberOfThreads) {
  const pipeline::Registration& registration = plainRegistration();
  const auto bytes = [&](const std::string& name) {
    std::ostringstream content;
    content << std::ifstream(dir_ / name, std::ios::binary).rdbuf();
    return content.str();
  };
  std::vector<std::string> first;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    std::vector<std::string> contents;
    for (const auto& name : writePictures(dir_, registration, kInfo))
      contents.push_back(bytes(name));
    if (first.empty()) first = contents;
    EXPECT_EQ(contents, first);
  }
}

TEST_F(Pictures, RejectionIsABanner) {
  pipeline::Registration registration = plainRegistration();
  registration.verdict = {verdict::Status::kRejected,
                          {"another place scores almost as high: this one has 1.10 times its "
                           "score",
                           "only 3 of 9 blocks, placed alone, agree with the whole"}};
  const auto names = writePictures(dir_, registration, kInfo);
  EXPECT_EQ(names.size(), 5U);
  for (const std::string& name : names) {
    EXPECT_GT(Picture(dir_ / name).share(isBannerRed), 0.02) << name;
  }
}

TEST_F(Pictures, ABendIsDrawnWhereHeightsAreNotKnown) {
  pipeline::Registration registration = plainRegistration();
  pipeline::Placed& placed = *registration.placed;
  placed.uncertainty.emplace();
  placed.uncertainty->height_deviation = std::numeric_limits<double>::infinity();
  const auto laid = [](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return point + Eigen::Vector3d(0.0, 0.02 * std::sin(point.x()), 0.0);
  };
  placed.followed = pipeline::Followed{
      deform::bendThrough(deform::Path({{0.0, 0.0}, {6.0, 0.0}}), placed.pose, 1.25, 0.005, laid),
      registration.maps.moving};
  writePictures(dir_, registration, kInfo);
  const auto is_band = [](int r, int g, int b) { return r > 190 && g > r && b > g && b - r > 20; };
  EXPECT_GT(Picture(dir_ / "deformation.png").share(is_band), 0.02);
}

TEST_F(Pictures, WithoutATransformOnlyMapsAndGuess) {
  pipeline::Registration registration = plainRegistration();
  registration.verdict = verdict::rejectBecause("the maps have nothing coherent in common");
  registration.transform.reset();
  registration.placed.reset();
  registration.trace = {};
  EXPECT_EQ(writePictures(dir_, registration, kInfo),
            (std::vector<std::string>{"exg_maps.png", "flow.png"}));
  EXPECT_TRUE(Picture(dir_ / "flow.png").ok());
  EXPECT_FALSE(fs::exists(dir_ / "overlay_after.png"));
}

TEST_F(Pictures, StripsOfAnyShapeAndDirection) {
  for (const double heading : {1.5707963, 2.6}) {
    for (const double width : {0.4, 2.4, 4.0}) {
      const pipeline::Registration registration =
          testing::testRegistration({7.0, 4.0, width, heading});
      for (const std::string& name : writePictures(dir_, registration, kInfo)) {
        const Picture picture(dir_ / name);
        ASSERT_TRUE(picture.ok());
        EXPECT_LE(picture.height(), 1400) << name << ' ' << heading << ' ' << width;
      }
      EXPECT_LT(Picture(dir_ / "overlay_after.png").share(isFringe),
                Picture(dir_ / "overlay_before.png").share(isFringe));
    }
  }
}

TEST_F(Pictures, CloudsWithoutColoursShowHeights) {
  pipeline::Registration registration = plainRegistration();
  registration.maps.fixed.exg =
      Raster<float>(registration.maps.fixed.frame.rows, registration.maps.fixed.frame.cols);
  writePictures(dir_, registration, kInfo);
  EXPECT_LT(Picture(dir_ / "overlay_after.png").share(isFringe),
            Picture(dir_ / "overlay_before.png").share(isFringe));
}

TEST_F(Pictures, OddNamesDoNotSpoilThem) {
  PictureInfo info = kInfo;
  info.fixed_name = "bad \xFF\xC0 bytes " + std::string(400, 'x');
  info.moving_name = "näme_日本.ply";
  for (const auto& name : writePictures(dir_, plainRegistration(), info)) {
    EXPECT_TRUE(Picture(dir_ / name).ok());
  }
}

TEST_F(Pictures, FailuresToWriteAreOutputErrors) {
  const pipeline::Registration& registration = plainRegistration();
  EXPECT_THROW(writePictures(dir_ / "missing", registration, kInfo), OutputError);
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  fs::create_symlink("/dev/full", dir_ / "flow.png");
  try {
    writePictures(dir_, registration, kInfo);
    FAIL() << "a full disk went unnoticed";
  } catch (const OutputError& error) {
    EXPECT_NE(std::string(error.what()).find("flow.png"), std::string::npos);
  }
}

TEST_F(Pictures, PngKeepsEveryPixel) {
  PictureCanvas canvas(37, 11, hexColour(0x123456));
  canvas.paint({3, 2, 30, 5}, [](int y, std::uint32_t* row) {
    for (int x = 0; x < 30; ++x) row[x] = static_cast<std::uint32_t>(0x010203 * (x + y));
  });
  canvas.write(dir_ / "small.png");
  const Picture picture(dir_ / "small.png");
  ASSERT_TRUE(picture.ok());
  EXPECT_EQ(picture.width(), 37);
  EXPECT_EQ(picture.height(), 11);
  EXPECT_EQ(picture.pixel(0, 0), 0x123456U);
  EXPECT_EQ(picture.pixel(3 + 29, 6), 0x010203U * 35U);
}

TEST(MapLayer, CoarseLevelsKeepPlaceAndMean) {
  map::GridMap map;
  map.frame = {{2.0, 3.0}, 0.02, 801, 801};
  map.weight = Raster<float>(801, 801, 1.0F);
  map.exg = Raster<float>(801, 801);
  for (int r = 0; r < 801; ++r) {
    for (int c = 0; c < 801; ++c) {
      const Eigen::Vector2d p = map.frame.centre(r, c);
      map.exg(r, c) = static_cast<float>(p.x() + 2.0 * p.y());
      if (r > 400) map.weight(r, c) = 0.0F;
    }
  }
  const MapLayer layer(map, PictureValue::kExg);
  EXPECT_EQ(layer.level(0.005).frame.cell, 0.02);
  EXPECT_EQ(layer.level(0.05).frame.cell, 0.04);
  for (const double scale : {100.0, 20.0, 12.0}) {
    View view{{5, 7, 60, 50}, {8.0, 6.0}, rotation2(0.3), scale};
    LayerRow row(layer, Eigen::Affine2d::Identity(), view);
    row.sample(30);
    const Eigen::Vector2d ground = view.ground({5 + 20.5, 30.5});
    ASSERT_GT(row.seen(20), 0.99F);
    EXPECT_NEAR(static_cast<double>(row.value(20)), ground.x() + 2.0 * ground.y(), 1e-3);
    EXPECT_LT((view.ground(view.pixel(ground)) - ground).norm(), 1e-9);
  }
  View north{{0, 0, 10, 10}, {8.0, 15.0}, Eigen::Matrix2d::Identity(), 50.0};
  LayerRow row(layer, Eigen::Affine2d::Identity(), north);
  row.sample(5);
  EXPECT_EQ(row.seen(5), 0.0F);
}

TEST(Outline, SmallestRectangleFollowsTheStrip) {
  for (const double heading : {0.0, 0.4, 1.5707963267948966, 2.5}) {
    Random random(1);
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 20000; ++i) {
      points.emplace_back(Eigen::Vector2d(3.0, -2.0) +
                          rotation2(heading) * Eigen::Vector2d(random.uniform(-5.0, 5.0),
                                                               random.uniform(-1.0, 1.0)));
    }
    const std::vector<Eigen::Vector2d> hull = convexHull(points);
    EXPECT_LT(hull.size(), 200U);
    const GroundRect rectangle = smallestRectangle(hull);
    EXPECT_NEAR(rectangle.half_extent.x(), 5.0, 0.02);
    EXPECT_NEAR(rectangle.half_extent.y(), 1.0, 0.02);
    EXPECT_NEAR(std::abs(rectangle.axes.col(0).dot(rotation2(heading).col(0))), 1.0, 1e-4);
    EXPECT_NEAR(rectangle.axes.determinant(), 1.0, 1e-12);
    EXPECT_GE(rectangle.axes(0, 0), 0.0);
    EXPECT_LT((rectangle.centre - Eigen::Vector2d(3.0, -2.0)).norm(), 0.02);
  }
}

TEST(Utf8, ReplacesWhatIsNotWellFormed) {
  EXPECT_EQ(validUtf8("plain näme 日本 😀"), "plain näme 日本 😀");
  const std::string sign = "\xEF\xBF\xBD";
  EXPECT_EQ(validUtf8("a\xFFz"), "a" + sign + "z");
  EXPECT_EQ(validUtf8("\xC0\x80"), sign + sign);             // overlong
  EXPECT_EQ(validUtf8("\xED\xA0\x80"), sign + sign + sign);  // surrogate
  EXPECT_EQ(validUtf8("\xE6\x97"), sign);                    // cut short
}

}  // namespace
}  // namespace agricolmap::report
