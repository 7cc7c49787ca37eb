#include "agricolmap/report/pictures/facts_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "agricolmap/crop/facts.hpp"
#include "agricolmap/crop/test_crop.hpp"
#include "agricolmap/report/draw/test_picture.hpp"

namespace agricolmap::report {
namespace {

using testing::Picture;
class FactsPicture : public testing::PictureTest {
 protected:
  /// Of the southernmost `share` of a sown field with a gap.
  Picture drawn(double share, const char* name, const std::vector<crop::Plot>& plots = {}) const {
    crop::TestField field;
    field.sow([](double) { return 0.0; }, 0.0,
              [](int row, int k) { return row == -6 && k > 1 && k < 6; });
    GridFrame frame = field.frame;
    frame.rows = static_cast<int>(share * frame.rows);
    Raster<float> exg(frame.rows, frame.cols);
    Raster<float> height = exg;
    std::copy_n(field.exg.begin(), exg.size(), exg.begin());
    std::copy_n(field.height.begin(), height.size(), height.begin());
    const crop::FieldFacts facts = crop::factsOf({frame, exg, height}, {0.0, 0.0}, plots, {});
    EXPECT_TRUE(facts.countable);
    writeFactsPicture(dir_ / name, frame, {facts, {0.0, 0.0}, plots, {}, "field"});
    return Picture(dir_ / name);
  }
};

bool isGap(int r, int g, int b) { return r > 200 && g < 90 && b < 90; }
constexpr double kKeyAlone = 1e-4;  // of the page is the gap of the key

TEST_F(FactsPicture, OfASquareFieldHasItBesideTheFigures) {
  const Picture picture = drawn(1.0, "square.png");
  ASSERT_TRUE(picture.ok());
  EXPECT_EQ(picture.width(), 1280);
  EXPECT_GT(picture.share(isGap), kKeyAlone);
}

TEST_F(FactsPicture, OfAWideFieldHasItAcrossThePage) {
  const std::vector<crop::Plot> plots = {{"A", {{1.0, 0.5}, {7.0, 0.5}, {7.0, 2.0}, {1.0, 2.0}}}};
  const Picture wide = drawn(0.3, "wide.png", plots);
  ASSERT_TRUE(wide.ok());
  // Its height is what the field's shape needs: no half of a page without any field.
  EXPECT_LT(wide.height(), 800);
  EXPECT_GT(wide.share(isGap), kKeyAlone);
  EXPECT_NE(wide.pixel(1200, 250), 0xffffffU);  // the field reaches across
}

}  // namespace
}  // namespace agricolmap::report
