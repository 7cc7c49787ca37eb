#include "agricolmap/report/pictures/change_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/report/draw/test_picture.hpp"

namespace agricolmap::report {
namespace {

using testing::Picture;
class ChangePicture : public testing::PictureTest {};

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// The west rose and is sure of it, the middle is not sure, the east fell; the north is not known.
change::HeightChange threeParts(int rows, int cols) {
  change::HeightChange change{Raster<float>(rows, cols, kNone), Raster<float>(rows, cols, kNone),
                              Raster<float>(rows, cols, kNone)};
  for (int r = 0; r < rows / 2; ++r) {
    for (int c = 0; c < cols; ++c) {
      const int part = 3 * c / cols;
      change.change(r, c) = 0.1F * static_cast<float>(1 - part);
      change.detection(r, c) = 0.03F;
      change.significant(r, c) = part == 1 ? 0.0F : 1.0F;
    }
  }
  return change;
}

bool isRise(int r, int g, int b) { return g - r > 60 && b - r > 60; }
bool isFall(int r, int g, int b) { return r - b > 60 && g - b > 30 && r > g; }
bool isHatch(int r, int g, int b) {
  return (r == 0xd3 && g == 0xd5 && b == 0xda) || (r == 0xec && g == 0xec && b == 0xef);
}

TEST_F(ChangePicture, TellsRiseFallAndWhatIsNotSureApart) {
  for (const int cells : {30, 3000}) {  // fewer than pixels, and more
    const change::HeightChange change = threeParts(cells, cells);
    const GridFrame frame{{3.0, 4.0}, 12.0 / cells, cells, cells};
    writeChangePicture(dir_ / "change.png", {change, frame, "a and b", {"rose 1 m2"}});
    const Picture picture(dir_ / "change.png");
    ASSERT_TRUE(picture.ok());
    EXPECT_GT(picture.share(isRise), 0.08) << cells;
    EXPECT_GT(picture.share(isFall), 0.08) << cells;
    EXPECT_GT(picture.share(isHatch), 0.08) << cells;
    // North is up: what is not known lies in the upper half of the map.
    EXPECT_EQ(picture.pixel(300, 200), 0xffffffU);
  }
}

TEST_F(ChangePicture, IsDrawnOfNarrowAndOfEmptyFields) {
  const change::HeightChange narrow = threeParts(400, 8);
  writeChangePicture(dir_ / "narrow.png", {narrow, {{0.0, 0.0}, 0.05, 400, 8}, "", {}});
  EXPECT_TRUE(Picture(dir_ / "narrow.png").ok());
  const change::HeightChange empty = threeParts(1, 5);
  writeChangePicture(dir_ / "empty.png", {empty, {{0.0, 0.0}, 0.05, 1, 5}, "", {}});
  EXPECT_TRUE(Picture(dir_ / "empty.png").ok());
  EXPECT_THROW(writeChangePicture(dir_ / "no/change.png", {empty, {{}, 0.05, 1, 5}, "", {}}),
               OutputError);
}

}  // namespace
}  // namespace agricolmap::report
