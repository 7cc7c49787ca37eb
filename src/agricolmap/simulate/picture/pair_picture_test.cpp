#include "agricolmap/simulate/picture/pair_picture.hpp"

#include <fstream>
#include <sstream>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/draw/test_picture.hpp"

namespace agricolmap::simulate {
namespace {

using testing::Picture;
class PairPicture : public testing::PictureTest {};

struct Pair {
  Cloud fixed;
  Cloud moving;
  Eigen::Affine3d fixed_from_moving;
};

/// Plants as discs on soil, seen every 3 cm by one cloud and every 1 cm, in a strip, by the other.
Pair makePair() {
  Pair pair;
  pair.fixed.origin = {432000.0, 5200000.0, 400.0};
  pair.moving.origin = {3.0, 4.0, 1.0};
  Eigen::Affine3d local = Eigen::Affine3d::Identity();  // local moving → local fixed
  local.linear().topLeftCorner<2, 2>() = rotation2(0.3);
  local.translation() = Eigen::Vector3d(3.0, 4.0, 0.5);
  pair.fixed_from_moving =
      Eigen::Translation3d(pair.fixed.origin) * local * Eigen::Translation3d(-pair.moving.origin);
  Random random(8);
  std::vector<Eigen::Vector2d> plants;
  for (int i = 0; i < 250; ++i)
    plants.emplace_back(random.uniform(0.0, 10.0), random.uniform(0.0, 8.0));
  const auto colour = [&](const Eigen::Vector2d& ground) {
    for (const Eigen::Vector2d& plant : plants) {
      if ((ground - plant).squaredNorm() < 0.01) return Rgb{40, 150, 40};
    }
    return Rgb{150, 120, 90};
  };
  for (double y = 0.015; y < 8.0; y += 0.03) {
    for (double x = 0.015; x < 10.0; x += 0.03) {
      pair.fixed.xyz.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.5F);
      pair.fixed.rgb.push_back(colour({x, y}));
    }
  }
  for (double v = 0.005; v < 1.4; v += 0.01) {
    for (double u = 0.005; u < 5.0; u += 0.01) {
      const Eigen::Vector3d ground = local * Eigen::Vector3d(u, v, 0.0);
      pair.moving.xyz.emplace_back(static_cast<float>(u), static_cast<float>(v), 0.0F);
      pair.moving.rgb.push_back(colour(ground.head<2>()));
    }
  }
  return pair;
}

bool isPlant(std::uint32_t pixel) { return ((pixel >> 8) & 255) > ((pixel >> 16) & 255) + 30; }

/// Share of the pixels at which the two close-ups, side by side, show the same: plant or soil.
double closeUpsAgree(const Picture& picture) {
  constexpr int kSquare = (report::kInnerWidth - 2 * report::kGap) / 3;
  constexpr int kLeft = report::kMargin + kSquare + report::kGap;
  int same = 0;
  int all = 0;
  // Away from labels and arrows, and where the strip, 1.4 m of 2 m wide, has points.
  for (int y = 72 + 130; y < 72 + 270; ++y) {
    for (int x = kLeft + 100; x < kLeft + kSquare - 100; ++x) {
      if (isPlant(picture.pixel(x, y)) == isPlant(picture.pixel(x + kSquare + report::kGap, y)))
        ++same;
      ++all;
    }
  }
  return static_cast<double>(same) / all;
}

TEST_F(PairPicture, ShowsTheSamePlaceFromBoth) {
  const Pair pair = makePair();
  writePairPicture(dir_ / "pair.png", pair.fixed, pair.moving, pair.fixed_from_moving);
  const Picture picture(dir_ / "pair.png");
  ASSERT_TRUE(picture.ok());
  EXPECT_EQ(picture.width(), report::kPageWidth);
  EXPECT_LT(picture.height(), 1500);
  EXPECT_GT(closeUpsAgree(picture), 0.95);
  // Neither an empty page nor one flat panel.
  EXPECT_LT(picture.share([](int r, int g, int b) { return r + g + b == 3 * 255; }), 0.4);
  EXPECT_GT(picture.share([](int r, int g, int b) { return g > r + 30 && g > b + 30; }), 0.05);

  const Eigen::Affine3d wrong = Eigen::Translation3d(0.4, 0.3, 0.0) * pair.fixed_from_moving;
  writePairPicture(dir_ / "wrong.png", pair.fixed, pair.moving, wrong);
  EXPECT_LT(closeUpsAgree(Picture(dir_ / "wrong.png")), 0.85);
}

TEST_F(PairPicture, DifferentFieldsHaveNoOutline) {
  const Pair pair = makePair();
  const auto whiteInMap = [&](bool same_field) {
    PairPictureInfo info;
    info.same_field = same_field;
    writePairPicture(dir_ / "pair.png", pair.fixed, pair.moving, pair.fixed_from_moving, info);
    const Picture picture(dir_ / "pair.png");
    int count = 0;
    for (int y = 72 + 60; y < 72 + 340; ++y) {
      for (int x = report::kMargin + 4; x < report::kMargin + 340; ++x) {
        if ((picture.pixel(x, y) & 0xF0F0F0U) == 0xF0F0F0U) ++count;
      }
    }
    return count;
  };
  EXPECT_GT(whiteInMap(true), 200);
  EXPECT_EQ(whiteInMap(false), 0);
}

TEST_F(PairPicture, SameOnAnyNumberOfThreads) {
  const Pair pair = makePair();
  std::string first;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    writePairPicture(dir_ / "pair.png", pair.fixed, pair.moving, pair.fixed_from_moving);
    std::ostringstream content;
    content << std::ifstream(dir_ / "pair.png", std::ios::binary).rdbuf();
    if (first.empty()) first = content.str();
    EXPECT_EQ(content.str() == first, true);
  }
}

TEST_F(PairPicture, StripsOfAnyShape) {
  const Pair pair = makePair();
  for (const float length : {0.3F, 1.4F, 5.0F}) {
    Pair cut = pair;
    cut.moving.xyz.clear();
    cut.moving.rgb.clear();
    for (std::size_t i = 0; i < pair.moving.size(); ++i) {
      if (pair.moving.xyz[i].x() > length) continue;
      cut.moving.xyz.push_back(pair.moving.xyz[i]);
      cut.moving.rgb.push_back(pair.moving.rgb[i]);
    }
    writePairPicture(dir_ / "pair.png", cut.fixed, cut.moving, cut.fixed_from_moving);
    const Picture picture(dir_ / "pair.png");
    ASSERT_TRUE(picture.ok());
    EXPECT_LT(picture.height(), 1500) << length;
  }
}

TEST_F(PairPicture, FailuresAreErrors) {
  Pair pair = makePair();
  EXPECT_THROW(
      writePairPicture(dir_ / "missing/pair.png", pair.fixed, pair.moving, pair.fixed_from_moving),
      OutputError);
  pair.moving.rgb.clear();
  EXPECT_THROW(writePairPicture(dir_ / "pair.png", pair.fixed, pair.moving, pair.fixed_from_moving),
               UsageError);
}

}  // namespace
}  // namespace agricolmap::simulate
