// A strip cut from real imagery, sampled anew, recoloured and laid wrong by a known affine. It is
// half real: the plants are, the second sensor is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/io/raster/raster_import.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap {
namespace {

std::optional<std::filesystem::path> soybeanFolder() {
  const char* const shared = std::getenv("AGRICOLMAP_SHARED");
  std::filesystem::path folder =
      std::filesystem::path(shared != nullptr ? shared : AGRICOLMAP_SHARED_DEFAULT) /
      "data/soybean_pliman";
  if (!std::filesystem::exists(folder / "soy_ortho.tif")) return std::nullopt;
  return folder;
}

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Another camera: exposure, white balance, tone curve and noise.
Rgb recolour(const Rgb& colour, Random& random) {
  const auto channel = [&](std::uint8_t value, double gain) {
    const double tone = 255.0 * std::pow(gain * value / 255.0, 0.85);
    return toByte(tone + random.normal(5.0));
  };
  return {channel(colour.r, 0.92), channel(colour.g, 0.85), channel(colour.b, 0.95)};
}

/// What the drone's map would be on another day: a fifth of the points gone, the rest shaken.
Cloud thinned(const Cloud& field, Random random) {
  Cloud cloud;
  cloud.name = "field";
  cloud.origin = field.origin;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (random.chance(0.2)) continue;
    const Eigen::Vector3d shaken(random.uniform(-0.007, 0.007), random.uniform(-0.007, 0.007),
                                 random.normal(0.005));
    cloud.xyz.push_back(field.xyz[i] + shaken.cast<float>());
    cloud.rgb.push_back(field.rgb[i]);
  }
  return cloud;
}

struct Strip {
  Cloud cloud;
  evaluate::Truth truth;
};

/// Points of `field` within `length` × `width` about `middle` (field file coordinates), three new
/// samples around each, in the file frame that `fixed_from_strip` maps from.
Strip cutStrip(const Cloud& field, const Eigen::Vector3d& middle, double length, double width,
               const Eigen::Affine3d& fixed_from_strip, Random random) {
  Strip strip;
  strip.cloud.name = "strip";
  strip.truth.best_affine = fixed_from_strip;
  const Eigen::Affine3d strip_from_fixed = fixed_from_strip.inverse();
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Eigen::Vector3d point = field.filePoint(i);
    if (std::abs(point.x() - middle.x()) > 0.5 * length) continue;
    if (std::abs(point.y() - middle.y()) > 0.5 * width) continue;
    for (int copy = 0; copy < 3; ++copy) {
      const Eigen::Vector3d sample =
          point + Eigen::Vector3d(random.uniform(-0.011, 0.011), random.uniform(-0.011, 0.011),
                                  random.normal(0.006));
      strip.cloud.xyz.push_back((strip_from_fixed * sample).cast<float>());
      strip.cloud.rgb.push_back(recolour(field.rgb[i], random));
    }
  }
  return strip;
}

TEST(RealField, FindsAStripOfRealSoybeans) {
  const auto folder = soybeanFolder();
  if (!folder) GTEST_SKIP() << "no shared data; set AGRICOLMAP_SHARED to their folder";
  const Cloud field = io::importOrthoDsm(*folder / "soy_ortho.tif", *folder / "soy_dsm.tif");
  const Box3 box = boundingBox(field);
  const Eigen::Vector3d middle =
      field.origin + box.centre().cast<double>() + Eigen::Vector3d(0.7, 0.2, 0.0);

  // The guess lays the strip's frame at its middle; it is wrong by 1 m, 3 degrees and 10 percent.
  const Eigen::Affine3d guess(Eigen::Translation3d(middle.x(), middle.y(), middle.z()));
  Eigen::Affine3d error = Eigen::Affine3d::Identity();
  error.linear() = Eigen::AngleAxisd(radians(3.0), Eigen::Vector3d::UnitZ()) *
                   Eigen::Vector3d(1.1, 0.9, 1.0).asDiagonal().toDenseMatrix();
  error.translation() = Eigen::Vector3d(0.8, -0.6, 0.2);
  const Eigen::Vector3d strip_middle = guess * error.translation();
  const Strip strip = cutStrip(field, strip_middle, 6.0, 2.2, guess * error, Random(3));
  ASSERT_GT(strip.cloud.size(), 50000U);

  Monitor monitor;
  const pipeline::Registration result = pipeline::registerClouds(
      thinned(field, Random(4)), strip.cloud, guess, pipeline::preset("default"), monitor);
  ASSERT_TRUE(result.transform);
  const evaluate::RegistrationErrors errors =
      evaluate::evaluateTransform(result.transform->fixed_from_moving, strip.truth, strip.cloud);
  RecordProperty("rms_mm", static_cast<int>(1000.0 * errors.rms));
  EXPECT_TRUE(errors.within({})) << "RMS " << errors.rms << " m, horizontal "
                                 << errors.rms_horizontal << " m, vertical " << errors.rms_vertical
                                 << " m, e_t " << errors.translation << " m, e_r "
                                 << errors.rotation << ", e_s " << errors.scale;
  EXPECT_EQ(result.verdict.status, verdict::Status::kAccepted);
}

}  // namespace
}  // namespace agricolmap
