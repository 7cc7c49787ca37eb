#include "agricolmap/batch/picture/summary_picture.hpp"

#include <array>
#include <cstdlib>
#include <utility>

#include "agricolmap/core/random.hpp"
#include "agricolmap/report/draw/test_picture.hpp"

namespace agricolmap::batch {
namespace {

using testing::Picture;
using testing::PictureTest;

/// A square of 40 m of one colour.
Cloud square(bool coloured) {
  Random random(4);
  Cloud cloud;
  cloud.name = "square.las";
  cloud.origin = {500000, 5400000, 300};
  for (int i = 0; i < 100'000; ++i) {
    cloud.xyz.emplace_back(random.uniform(0, 40), random.uniform(0, 40), random.uniform(0, 1));
    if (coloured) cloud.rgb.push_back({90, 90, 20});
  }
  return cloud;
}

Record stripAt(const std::string& status, double x) {
  Record record;
  record.map = "field";
  record.status = status;
  for (const auto& [dx, dy] : {std::pair{0.0, 5.0}, {3.0, 5.0}, {3.0, 35.0}, {0.0, 35.0}}) {
    record.outline.emplace_back(500000.0 + x + dx, 5400000.0 + dy);
  }
  return record;
}

class SummaryPicture : public PictureTest {};

TEST_F(SummaryPicture, ShowsEachStripInTheColourOfItsStatus) {
  const Cloud cloud = square(true);
  const MapGround ground = groundOf("field", CloudStream(cloud));
  const std::vector<Record> records = {stripAt("accepted", 5.0), stripAt("rejected", 15.0),
                                       stripAt("ambiguous", 25.0), stripAt("failed", 30.0)};
  const auto drawn = [&](std::span<const Record> some) {
    writeSummaryPicture(dir_ / "summary.png", std::span(&ground, 1), some);
    const Picture picture(dir_ / "summary.png");
    EXPECT_TRUE(picture.ok());
    EXPECT_GT(picture.share([](int r, int g, int b) { return r == 90 && g == 90 && b == 20; }),
              0.5);
    const auto share = [&](int red, int green, int blue) {
      return picture.share([=](int r, int g, int b) {
        return std::abs(r - red) + std::abs(g - green) + std::abs(b - blue) < 12;
      });
    };
    return std::array{share(0x56, 0xb4, 0xe9), share(0xd5, 0x5e, 0x00), share(0xf0, 0xe4, 0x42)};
  };
  const auto legend = drawn({});
  const auto all = drawn(records);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_GT(all[i], 3.0 * legend[i] + 2e-4) << i;
  const auto first = drawn(std::span(records).first(1));
  EXPECT_GT(first[0], 2e-4);
  EXPECT_EQ(first[1], legend[1]);
}

TEST_F(SummaryPicture, ShowsHeightsOfAMapWithoutColours) {
  const Cloud cloud = square(false);
  const MapGround ground = groundOf("field", CloudStream(cloud));
  writeSummaryPicture(dir_ / "summary.png", std::span(&ground, 1), {});
  const Picture picture(dir_ / "summary.png");
  EXPECT_GT(picture.share([](int r, int g, int b) { return r == g && g == b && r < 235; }), 0.4);
}

}  // namespace
}  // namespace agricolmap::batch
