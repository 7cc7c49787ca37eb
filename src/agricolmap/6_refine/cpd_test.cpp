#include "agricolmap/6_refine/cpd.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agricolmap/6_refine/cpd_fit.hpp"
#include "agricolmap/6_refine/cpd_kernel.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

using Points = std::vector<VegetationPoint>;

struct Plant {
  Eigen::Vector2d position;
  double radius;
  double height;
};

/// Rows 0.5 m apart along x, plants about 0.18 m apart with jitter and gaps.
std::vector<Plant> makeField(double length, double width, Random& random) {
  std::vector<Plant> plants;
  for (double y = -0.5 * width; y < 0.5 * width; y += 0.5) {
    for (double x = -0.5 * length; x < 0.5 * length; x += 0.18) {
      if (random.chance(0.1)) continue;
      plants.push_back({{x + random.normal(0.03), y + random.normal(0.02)},
                        random.uniform(0.04, 0.09),
                        random.uniform(0.1, 0.25)});
    }
  }
  return plants;
}

struct Sampling {
  double per_plant = 40.0;  ///< points
  double missing = 0.4;     ///< share of plants not seen
  double outliers = 0.1;    ///< points strewn over the area, relative to those of plants
  double noise = 0.01;      ///< of each point [m]
  double height_bias = 0.0;
};

/// Points of the plants inside `box`, each plant seen on its own leaves.
Points sample(const std::vector<Plant>& plants, const Box2& box, const Sampling& how,
              Random& random) {
  Points points;
  for (const Plant& plant : plants) {
    if (!box.contains(plant.position) || random.chance(how.missing)) continue;
    for (int i = 0; i < static_cast<int>(how.per_plant); ++i) {
      const double radius = plant.radius * std::sqrt(random.uniform());
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      points.push_back({plant.position +
                            radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)) +
                            Eigen::Vector2d(random.normal(how.noise), random.normal(how.noise)),
                        plant.height * (1.0 - radius / 0.2) + how.height_bias + random.normal(0.02),
                        random.uniform(0.3, 1.0)});
    }
  }
  const auto strewn = static_cast<std::size_t>(how.outliers * static_cast<double>(points.size()));
  for (std::size_t i = 0; i < strewn; ++i) {
    const Eigen::Vector2d share(random.uniform(), random.uniform());
    points.push_back({box.min() + share.cwiseProduct(box.sizes()), random.uniform(0.0, 0.2), 0.5});
  }
  return points;
}

/// A pair with a known affine: fixed = truth · moving.
struct Scene {
  Points fixed;
  Points moving;
  CpdPose truth;
};

CpdPose makePose(double x, double y, double yaw, double scale_x, double scale_y, double z) {
  CpdPose pose;
  pose.plane.linear() = composeHorizontal({yaw, scale_x, scale_y, 0.0});
  pose.plane.translation() = Eigen::Vector2d(x, y);
  pose.height_offset = z;
  return pose;
}

Scene makeScene(std::uint64_t seed, const Sampling& fixed, const Sampling& moving,
                double length = 10.0) {
  Random random(seed);
  const std::vector<Plant> plants = makeField(length + 3.0, 8.0, random);
  Scene scene;
  scene.truth =
      makePose(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-0.3, 0.3),
               random.uniform(0.8, 1.2), random.uniform(0.8, 1.2), random.uniform(-0.2, 0.2));
  const Box2 wide(Eigen::Vector2d(-0.5 * length - 1.5, -4.0),
                  Eigen::Vector2d(0.5 * length + 1.5, 4.0));
  const Box2 strip(Eigen::Vector2d(-0.5 * length, -1.0), Eigen::Vector2d(0.5 * length, 1.0));
  scene.fixed = sample(plants, wide, fixed, random);
  scene.moving = sample(plants, strip, moving, random);
  const Eigen::Affine2d inverse = scene.truth.plane.inverse();
  for (VegetationPoint& p : scene.moving) {
    p.position = inverse * p.position;
    p.height -= scene.truth.height_offset;
  }
  return scene;
}

/// RMS horizontal displacement over the moving points [m].
double error(const Scene& scene, const CpdPose& pose) {
  double sum = 0.0;
  for (const VegetationPoint& p : scene.moving) {
    sum += (pose.plane * p.position - scene.truth.plane * p.position).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(scene.moving.size()));
}

/// The truth, moved about the strip's centre by `shift` [m], `yaw` [rad] and relative `scale`.
CpdPose disturbed(const Scene& scene, double shift, double yaw, double scale, Random& random) {
  const auto sign = [&] { return random.chance(0.5) ? 1.0 : -1.0; };
  const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
  CpdPose pose = scene.truth;
  const Eigen::Vector2d centre = scene.truth.plane.translation();
  pose.plane.linear() =
      composeHorizontal({sign() * yaw, 1.0 + sign() * scale, 1.0 + sign() * scale, 0.0}) *
      scene.truth.plane.linear();
  pose.plane.translation() =
      centre + shift * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  pose.height_offset += random.normal(0.03);
  return pose;
}

constexpr double kDegree = std::numbers::pi / 180.0;
const Sampling kDrone{15.0, 0.1, 0.1, 0.02, 0.03};
const Sampling kRobot{60.0, 0.4, 0.2, 0.005, 0.0};

TEST(Cpd, RecoversAnAffineFromANearStart) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Scene scene = makeScene(seed, kDrone, kRobot);
    Random random = Random::stream(17, seed);
    const CpdPose start = disturbed(scene, random.uniform(0.03, 0.08), 1.0 * kDegree, 0.02, random);
    const CpdResult result = refineByCpd(scene.fixed, scene.moving, start, {});
    std::printf("seed %lu: %.1f -> %.2f mm, %d it, share %.2f rms %.1f mm pairs %zu\n", seed,
                1e3 * error(scene, start), 1e3 * error(scene, result.pose), result.iterations,
                result.matched_share, 1e3 * result.rms, result.pairs);
    ASSERT_EQ(result.status, CpdStatus::kConverged) << seed;
    EXPECT_LT(error(scene, result.pose), 0.01) << seed << ", from " << error(scene, start);
  }
}

}  // namespace
}  // namespace agricolmap
