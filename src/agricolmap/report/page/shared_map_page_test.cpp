#include "agricolmap/report/page/shared_map_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace agricolmap::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

fuse::SharedMap smallMap(int side) {
  fuse::SharedMap map;
  map.layers.frame = {{1.0, 2.0}, 0.02, side, side};
  const Raster<float> half(side, side, 0.5F);
  map.layers.exg = map.layers.plant_height = half;
  map.layers.plane_error = map.layers.height_error = half;
  map.layers.colour = Raster<Rgb>(side, side);
  map.layers.source = Raster<std::uint16_t>(side, side, fuse::kFixedSource);
  map.layers.exg[0] = std::nanf("");
  return map;
}

TEST(SharedMapPage, TheSceneHasAllLayersInABoundedSize) {
  fuse::SharedMap map = smallMap(1001);
  const auto scene = sharedMapScene(map);
  const auto& picture = scene["maps"]["fixed"][0];
  EXPECT_EQ(picture["cols"], 501);  // every second cell, the odd one included
  EXPECT_EQ(picture["layers"].size(), 6U);
  EXPECT_EQ(picture["local_from_image"][4], 1.0);
  EXPECT_EQ(scene["maps"]["scales"]["plant_height"][1], 0.5);
  map.flat = true;
  EXPECT_EQ(sharedMapScene(map)["maps"]["fixed"][0]["layers"].size(), 4U);
}

TEST(SharedMapPage, NamesOfSourcesStayText) {
  const std::string page =
      sharedMapPage(R"({"sources": [{"id": "</script><script>alert(1)</script>"}]})", nullptr);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("<li>&lt;/script&gt;"));
}

}  // namespace
}  // namespace agricolmap::report
