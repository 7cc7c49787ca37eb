#include "experiments/pairs/dates.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/hash.hpp"

namespace agricolmap::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// Direction in which sums of greenness differ most from row to row, on all three dates.
constexpr double kRowHeading = -3.0 * kDegree;
constexpr double kAskew = 3.0 * kDegree;
constexpr double kLeastValid = 0.99;  // share of a strip
constexpr int kAttempts = 2000;

bool isValid(const io::RasterImage& image, const Eigen::Vector2d& point) {
  const Eigen::Vector2d pixel = image.place.world_from_pixel->inverse() * point;
  const int row = static_cast<int>(std::floor(pixel.y()));
  const int col = static_cast<int>(std::floor(pixel.x()));
  return image.valid.contains(row, col) && image.valid(row, col) != 0;
}

double shareValid(const io::RasterImage& image, const Eigen::Affine2d& place, double length,
                  double width) {
  int good = 0;
  int count = 0;
  for (double x = -0.5; x <= 0.501; x += 0.02) {
    for (double y = -0.5; y <= 0.501; y += 0.05) {
      good += isValid(image, place * Eigen::Vector2d(x * length, y * width)) ? 1 : 0;
      ++count;
    }
  }
  return static_cast<double>(good) / count;
}

/// Mosaic's coordinates from the strip's: x forwards, from its middle.
Eigen::Affine2d placeStrip(const io::RasterImage& image, const DatePair& dates,
                           const simulate::UgvOptions& ugv, Random& random) {
  const Eigen::Affine2d& mosaic = *image.place.world_from_pixel;
  const Eigen::Vector2d corner = mosaic.translation();
  const Eigen::Vector2d opposite = mosaic * Eigen::Vector2d(image.valid.cols(), image.valid.rows());
  const double field = opposite.x() - corner.x();
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const double askew = random.uniform(-kAskew, kAskew);
    const double heading = kRowHeading + askew + (random.chance(0.5) ? std::numbers::pi : 0.0);
    const double half =
        0.5 * (ugv.length * std::abs(std::cos(heading)) + ugv.width * std::abs(std::sin(heading)));
    const double x =
        corner.x() + random.uniform(dates.begin * field + half, dates.end * field - half);
    const double y = random.uniform(opposite.y(), corner.y());
    const Eigen::Affine2d place = Eigen::Translation2d(x, y) * Eigen::Rotation2Dd(heading);
    if (shareValid(image, place, ugv.length, ugv.width) >= kLeastValid) return place;
  }
  throw InputError(
      fmt::format("{}: no place for a strip of {} x {} m between {:.0f} and {:.0f} % "
                  "of its length; shorten ugv.length and ugv.width",
                  image.name, ugv.length, ugv.width, 100.0 * dates.begin, 100.0 * dates.end));
}

/// Calls `visit(row, col, place of the pixel's centre)` for all pixels with data.
template <typename Visit>
void forValid(const io::RasterImage& image, const Visit& visit) {
  const Eigen::Affine2d& mosaic = image.place.world_from_pixel.value();
  for (int r = 0; r < image.valid.rows(); ++r) {
    for (int c = 0; c < image.valid.cols(); ++c) {
      if (image.valid(r, c) != 0) visit(r, c, mosaic * Eigen::Vector2d(c + 0.5, r + 0.5));
    }
  }
}

Eigen::Vector3d onGround(const Eigen::Vector2d& point) { return {point.x(), point.y(), 0.0}; }

}  // namespace

std::string dateFile(const std::string& day) {
  return fmt::format("data/soybean_dates/201808{}_Lamberton_clipped.tif", day);
}

Cloud layFlat(const io::RasterImage& image) {
  Cloud cloud;
  cloud.name = image.name;
  cloud.origin = onGround(image.place.world_from_pixel.value().translation().array().round());
  forValid(image, [&](int row, int col, const Eigen::Vector2d& at) {
    cloud.xyz.emplace_back((onGround(at) - cloud.origin).cast<float>());
    cloud.rgb.push_back(image.colour(row, col));
  });
  return cloud;
}

FlatStrip cutStrip(const io::RasterImage& image, const DatePair& dates,
                   const simulate::SimulationOptions& options) {
  Random random =
      Random::stream(static_cast<std::uint64_t>(options.seed), hashText("strip of a flight"));
  const Eigen::Affine2d place = placeStrip(image, dates, options.ugv, random);
  const Eigen::Affine2d strip_from_world = place.inverse();
  FlatStrip strip;
  const Eigen::Vector3d centre = onGround(place.translation());
  strip.geotag = simulate::drawGeotag(options.geotag, centre, 0.0, random.bits());
  const Eigen::Affine3d file_from_world = strip.geotag.nominal.inverse(Eigen::Affine);
  strip.cloud.name = "strip of " + image.name;
  strip.cloud.origin = (file_from_world * centre).array().round().matrix();
  const Eigen::Vector2d half(0.5 * options.ugv.length, 0.5 * options.ugv.width);
  forValid(image, [&](int row, int col, const Eigen::Vector2d& at) {
    Eigen::Vector2d local = strip_from_world * at;
    if ((local.cwiseAbs() - half).maxCoeff() > 0.0) return;
    if (options.mirrored) local[dates.end_for_end ? 0 : 1] *= -1.0;
    const Eigen::Vector3d in_file = file_from_world * onGround(place * local);
    strip.cloud.xyz.emplace_back((in_file - strip.cloud.origin).cast<float>());
    strip.cloud.rgb.push_back(image.colour(row, col));
  });
  return strip;
}

}  // namespace agricolmap::experiments
