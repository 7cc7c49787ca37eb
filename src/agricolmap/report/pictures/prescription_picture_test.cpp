#include "agricolmap/report/pictures/prescription_picture.hpp"

#include <gtest/gtest.h>

#include "agricolmap/prescribe/test_earth.hpp"
#include "agricolmap/report/draw/test_picture.hpp"

namespace agricolmap::report {
namespace {

using testing::Picture;
class PrescriptionPicture : public testing::PictureTest {};

TEST_F(PrescriptionPicture, ShowsClassesWhereTheyLieAndWhatGetsNothing) {
  const prescribe::Earth earth = prescribe::testEarth();
  for (const double height : {20.0, 80.0}) {  // wide and narrow fields
    const GridFrame frame{{500000.0, 5300000.0}, 0.5, static_cast<int>(height / 0.5), 80};
    Raster<float> values(frame.rows, frame.cols);
    for (int row = 0; row < frame.rows; ++row) {
      for (int col = 0; col < frame.cols; ++col) {
        values(row, col) = static_cast<float>(col / 20);  // four stripes, low in the west
      }
    }
    prescribe::Lattice lattice = prescribe::degreeLattice(frame, earth, 5.0, 5.0);
    Raster<float> means = prescribe::squareMeans(frame, values, lattice, earth, 0.5);
    ASSERT_TRUE(prescribe::trim(lattice, means));
    const prescribe::Plan plan =
        prescribe::planOf(lattice, means, {0.5, 1.5, 2.5}, {30.0, 20.0, 10.0, 0.0},
                          prescribe::rateUnit("kg/ha"), earth);
    const prescribe::TaskGrid grid = prescribe::taskGridOf(plan, earth);
    const PlacedPlan placed{
        plan, grid, prescribe::GridKind::kZones, "map", "cover", "", "urea", {}, {5.0, 5.0, 0.5},
        {}};
    writePrescriptionPicture(
        dir_ / "rates.png", {placed, prescribe::placeFromFile(plan.lattice, earth), frame, values});
    const Picture picture(dir_ / "rates.png");
    ASSERT_TRUE(picture.ok());
    EXPECT_EQ(picture.width(), 1280);
    EXPECT_EQ(classColour(plan, 3), 0xc3c7cdU);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t colour = classColour(plan, i);
      const auto is = [colour](int r, int g, int b) {
        return (static_cast<std::uint32_t>(r) << 16 | static_cast<std::uint32_t>(g) << 8 |
                static_cast<std::uint32_t>(b)) == colour;
      };
      EXPECT_GT(picture.share(is), 0.02) << i;
    }
  }
}

}  // namespace
}  // namespace agricolmap::report
