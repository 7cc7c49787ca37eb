#include "agricolmap/simulate/ortho/ortho.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/simulate/field/noise.hpp"

namespace agricolmap::simulate {
namespace {

SimulationOptions stripOptions() {
  SimulationOptions options = cropPreset(Crop::kSugarBeet10m);
  options.ugv.length = 4.0;
  options.ugv.width = 1.6;
  options.ugv.spacing = 0.006;
  return options;
}

OrthoField stripedField() {
  OrthoField field;
  field.name = "made-up mosaic";
  field.gsd = 0.012;
  field.colour = Raster<Rgb>(600, 700);
  for (int r = 0; r < 600; ++r) {
    for (int c = 0; c < 700; ++c) {
      const bool row = r % 40 < 12 && noiseAt(5, c / 9.0, std::floor(r / 40.0)) > -0.3F;
      field.colour(r, c) = row ? Rgb{70, 130, 50} : Rgb{130, 110, 95};
    }
  }
  return field;
}

TEST(SimulateFromOrtho, KeepsTheTruthAndTheMask) {
  OrthoField field = stripedField();
  field.valid = Raster<std::uint8_t>(600, 700, 1);
  for (int r = 0; r < 600; ++r) {
    for (int c = 600; c < 700; ++c) field.valid(r, c) = 0;
  }
  SimulationOptions options = stripOptions();
  options.ugv.drift = 0.0;
  const SimulatedPair pair = simulateFromOrtho(field, options);
  ASSERT_EQ(pair.truth.size(), pair.ugv.size());
  for (std::size_t i = 0; i < pair.truth.size(); i += 97) {
    EXPECT_LT((pair.nominal * pair.ugv.filePoint(i) - pair.truth[i]).norm(), 1e-5);
  }
  const Box3 box = boundingBox(pair.uav);
  EXPECT_NEAR(box.max.x(), 600 * 0.012, 0.02);
  // Made-up plants stand above the soil.
  EXPECT_GT(boundingBox(pair.ugv).extent().z(), 0.1F);
}

TEST(SimulateFromOrtho, RefusesRastersThatDoNotFit) {
  OrthoField field = stripedField();
  field.height = Raster<float>(10, 10);
  EXPECT_THROW(simulateFromOrtho(field, stripOptions()), InputError);
  field = stripedField();
  field.valid = Raster<std::uint8_t>(600, 700, 0);
  EXPECT_THROW(simulateFromOrtho(field, stripOptions()), InputError);
}

TEST(SimulateFromOrtho, SaysWhenTheMosaicIsTooSmallForTheStrip) {
  SimulationOptions options = stripOptions();
  options.ugv.length = 9.0;
  try {
    simulateFromOrtho(stripedField(), options);
    FAIL() << "no error";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("made-up mosaic"), std::string::npos) << what;
    EXPECT_NE(what.find("ugv.length"), std::string::npos) << what;
  }
}

TEST(SimulateFromOrtho, KeepsTheCoordinatesOfTheMosaic) {
  OrthoField field = stripedField();
  field.corner = Eigen::Vector2d(734337.25, 4489012.5);
  field.height = Raster<float>(600, 700);
  for (int r = 0; r < 600; ++r) {
    for (int c = 0; c < 700; ++c) {
      field.height(r, c) = 303.0F + (field.colour(r, c).g > 120 ? 0.15F : 0.0F);
    }
  }
  SimulationOptions options = stripOptions();
  const SimulatedPair there = simulateFromOrtho(field, options);
  const Eigen::Vector3d lowest = there.uav.origin + boundingBox(there.uav).min.cast<double>();
  EXPECT_NEAR(lowest.x(), 734337.25, 0.03);
  EXPECT_NEAR(lowest.y(), 4489012.5, 0.03);
  EXPECT_NEAR(lowest.z(), 303.0, 0.1);
  EXPECT_NEAR(there.truth.front().z(), 303.1, 0.2);
  options.geotag.utm = false;
  const SimulatedPair here = simulateFromOrtho(field, options);
  EXPECT_EQ(here.uav.xyz, there.uav.xyz);
  EXPECT_EQ(here.uav.origin, Eigen::Vector3d::Zero());
  const Eigen::Vector3d moved = there.truth.front() - here.truth.front();
  EXPECT_NEAR((moved - there.uav.origin).norm(), 0.0, 1e-6);
}

TEST(SimulateFromOrtho, SameBitsOnAnyNumberOfThreads) {
  const OrthoField field = stripedField();
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return simulateFromOrtho(field, stripOptions());
  };
  const SimulatedPair one = run(1);
  const SimulatedPair many = run(3);
  EXPECT_EQ(one.uav.xyz, many.uav.xyz);
  EXPECT_EQ(one.ugv.xyz, many.ugv.xyz);
  EXPECT_EQ(one.ugv.rgb, many.ugv.rgb);
}

TEST(SimulateFromOrtho, OtherFieldIsMarkedAndDiffers) {
  const OrthoField field = stripedField();
  SimulationOptions options = stripOptions();
  const SimulatedPair same = simulateFromOrtho(field, options);
  options.other_field = true;
  const SimulatedPair other = simulateFromOrtho(field, options);
  EXPECT_TRUE(same.overlaps);
  EXPECT_FALSE(other.overlaps);
  EXPECT_EQ(same.uav.xyz, other.uav.xyz);
  EXPECT_NE(same.ugv.rgb, other.ugv.rgb);
}

}  // namespace
}  // namespace agricolmap::simulate
