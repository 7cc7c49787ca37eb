#include "agricolmap/simulate/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

/// How a camera turns linear colour into 8 bits: white balance, exposure, gamma, noise.
class Camera {
 public:
  Camera(Random random, double noise) : noise_(noise) {
    exposure_ = random.uniform(0.85, 1.25);
    gamma_ = random.uniform(0.5, 0.75);
    for (double& gain : gain_) gain = random.uniform(0.88, 1.12);
    haze_ = random.uniform(0.0, 0.03);
  }
  /// `light`: local illumination, 1 = nominal.
  Rgb shoot(const Colour& colour, double light, Random& random) const {
    std::uint8_t out[3];
    for (int k = 0; k < 3; ++k) {
      const double linear =
          std::max(0.0, gain_[k] * exposure_ * light *
                                static_cast<double>(colour[static_cast<std::size_t>(k)]) +
                            haze_);
      const double value = 255.0 * std::pow(linear, gamma_) + random.normal(noise_);
      out[k] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
    }
    return {out[0], out[1], out[2]};
  }

 private:
  double exposure_ = 1.0, gamma_ = 0.6, haze_ = 0.0, noise_;
  double gain_[3] = {1.0, 1.0, 1.0};
};

/// Gaussian blur as three box blurs along rows and columns (sigma in cells).
void blur(Raster<float>& raster, double sigma) {
  if (sigma < 0.3) return;
  const int radius = std::max(1, static_cast<int>(std::lround(sigma * 0.98)));
  const auto pass = [&](bool along_rows) {
    const int lines = along_rows ? raster.rows() : raster.cols();
    const int length = along_rows ? raster.cols() : raster.rows();
    parallelFor(static_cast<std::size_t>(lines), [&](std::size_t line) {
      const int l = static_cast<int>(line);
      std::vector<float> in(static_cast<std::size_t>(length));
      const auto at = [&](int i) -> float& { return along_rows ? raster(l, i) : raster(i, l); };
      for (int i = 0; i < length; ++i) in[static_cast<std::size_t>(i)] = at(i);
      double sum = 0.0;
      const auto clamped = [&](int i) {
        return static_cast<double>(in[static_cast<std::size_t>(std::clamp(i, 0, length - 1))]);
      };
      for (int i = -radius; i <= radius; ++i) sum += clamped(i);
      for (int i = 0; i < length; ++i) {
        at(i) = static_cast<float>(sum / (2 * radius + 1));
        sum += clamped(i + radius + 1) - clamped(i - radius);
      }
    });
  };
  for (int i = 0; i < 3; ++i) {
    pass(true);
    pass(false);
  }
}

/// Patches without points: smooth noise above a threshold that gives the wanted share.
class Holes {
 public:
  Holes(std::uint64_t seed, double share) : noise_(seed, 0.12), wide_(seed ^ 1, 0.5) {
    // Value noise of two scales is close to normal with deviation 0.42.
    threshold_ = share <= 0.0 ? 10.0 : 0.42 * std::sqrt(2.0) * inverseErf(1.0 - 2.0 * share);
  }
  bool at(double x, double y) const {
    return 0.7 * noise_.at(x, y) + 0.7 * wide_.at(x, y) > threshold_;
  }

 private:
  static double inverseErf(double x) {  // Winitzki 2008, good to 2e-3
    const double ln = std::log(1.0 - x * x);
    const double a = 2.0 / (std::numbers::pi * 0.147) + 0.5 * ln;
    return std::copysign(std::sqrt(std::sqrt(a * a - ln / 0.147) - a), x);
  }
  SmoothNoise noise_, wide_;
  double threshold_;
};

constexpr std::uint64_t kUavSalt = 0x1001;
constexpr std::uint64_t kUgvSalt = 0x2002;

/// Joins per-row lists in order.
std::vector<SensedPoint> join(std::vector<std::vector<SensedPoint>>& rows) {
  std::size_t count = 0;
  for (const auto& row : rows) count += row.size();
  std::vector<SensedPoint> points;
  points.reserve(count);
  for (auto& row : rows) {
    points.insert(points.end(), row.begin(), row.end());
    row = {};
  }
  return points;
}

/// Line of sight from canopy cells to the cameras on the path.
class Visibility {
 public:
  Visibility(const Canopy& canopy, const StripPose& strip, double camera_height)
      : canopy_(canopy), camera_height_(camera_height) {
    tallest_ = *std::max_element(canopy.height.begin(), canopy.height.end());
    along_ = Eigen::Vector2d(std::cos(strip.heading), std::sin(strip.heading));
    left_ = Eigen::Vector2d(-along_.y(), along_.x());
    centre_ = strip.centre;
  }
  /// True when the surface at `p`, height `z`, is seen from one of the places behind it.
  bool sees(const Eigen::Vector2d& p, float z) const {
    const double v = left_.dot(p - centre_);
    for (const double behind : {0.5, 0.9, 0.25, 1.4}) {
      const Eigen::Vector2d to_camera = -behind * along_ - v * left_;
      if (clear(p, z, to_camera)) return true;
    }
    return false;
  }

 private:
  bool clear(const Eigen::Vector2d& p, float z, const Eigen::Vector2d& to_camera) const {
    const double distance = to_camera.norm();
    const double cell = canopy_.frame.cell;
    const double stride = std::max(2.0 * cell, 0.01);
    const Eigen::Vector2d step = to_camera / distance * stride / cell;
    const auto rise =
        static_cast<float>((camera_height_ - static_cast<double>(z)) * stride / distance);
    if (rise <= 0.0F) return false;
    Eigen::Vector2d at = canopy_.frame.cellOf(p);
    float ray = z + 0.004F;
    for (double gone = stride; gone < distance; gone += stride) {
      at += step;
      ray += rise;
      if (ray > tallest_) return true;
      const int r = static_cast<int>(std::lround(at.y())),
                c = static_cast<int>(std::lround(at.x()));
      if (!canopy_.height.contains(r, c)) return true;
      if (canopy_.height(r, c) > ray) return false;
    }
    return true;
  }
  const Canopy& canopy_;
  double camera_height_;
  float tallest_;
  Eigen::Vector2d along_, left_, centre_;
};

/// The map's smooth bend along the path: what a drifting odometry leaves, in strip coordinates.
class Drift {
 public:
  Drift(Random random, double amplitude, double length) : half_(0.5 * length) {
    for (auto& axis : coefficient_) {
      for (double& c : axis) c = random.normal(0.5) * amplitude;
    }
    phase_ = random.uniform(0.0, 2.0 * std::numbers::pi);
  }
  Eigen::Vector3d at(double along) const {
    const double t = along / half_;
    const double basis[3] = {t * t, t * t * t, 0.4 * std::sin(std::numbers::pi * t + phase_)};
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < 3; ++k) d[axis] += coefficient_[axis][k] * basis[k];
    }
    d.z() *= 0.3;
    return d;
  }

 private:
  double half_;
  double coefficient_[3][3];
  double phase_;
};

}  // namespace

std::vector<SensedPoint> senseFromAbove(const Canopy& canopy, const SimulationOptions& options,
                                        std::uint64_t seed) {
  const UavOptions& o = options.uav;
  const double cell = canopy.frame.cell;
  // What bundle adjustment and dense matching make of the surface.
  Raster<float> surface = canopy.height;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    surface[i] = canopy.ground[i] +
                 static_cast<float>(o.canopy_gain) * (canopy.height[i] - canopy.ground[i]);
  }
  blur(surface, o.smoothing / cell);
  const int every = std::max(1, static_cast<int>(std::lround(o.spacing / cell)));
  const Camera camera(Random::stream(seed, kUavSalt), o.colour_noise);
  const SmoothNoise light(seed ^ 0xA1, 9.0), bumps(seed ^ 0xA2, 0.08);
  const Holes holes(seed ^ 0xA3, o.holes);
  const double reach2 = 0.25 * canopy.frame.cols * canopy.frame.cols * cell * cell;
  const int rows = canopy.frame.rows / every;
  std::vector<std::vector<SensedPoint>> lines(static_cast<std::size_t>(rows));
  parallelFor(lines.size(), [&](std::size_t line) {
    Random random = Random::stream(seed ^ kUavSalt, line);
    for (int k = 0; k + 1 <= canopy.frame.cols / every; ++k) {
      const Eigen::Vector2d middle = canopy.frame.centre(
          (static_cast<double>(line) + 0.5) * every - 0.5, (k + 0.5) * every - 0.5);
      const double jitter = 0.35 * o.spacing;
      const Eigen::Vector2d p = middle + Eigen::Vector2d(random.uniform(-jitter, jitter),
                                                         random.uniform(-jitter, jitter));
      const Eigen::Vector2d at = canopy.frame.cellOf(p);
      const int r = std::clamp(static_cast<int>(std::lround(at.y())), 0, canopy.frame.rows - 1);
      const int c = std::clamp(static_cast<int>(std::lround(at.x())), 0, canopy.frame.cols - 1);
      Colour mean{};
      int count = 0;
      for (int dr = 0; dr < every; ++dr) {
        for (int dc = 0; dc < every; ++dc) {
          const int rr = r + dr - every / 2, cc = c + dc - every / 2;
          if (!canopy.colour.contains(rr, cc)) continue;
          for (std::size_t b = 0; b < 3; ++b) mean[b] += canopy.colour(rr, cc)[b];
          ++count;
        }
      }
      for (float& v : mean) v /= static_cast<float>(std::max(1, count));
      const double sun = 1.0 + 0.12 * light.at(p.x(), p.y());
      SensedPoint point;
      point.truth = {p.x(), p.y(), static_cast<double>(surface(r, c))};
      point.measured = point.truth;
      point.measured.z() += 2.0 * o.noise * bumps.at(p.x(), p.y()) + random.normal(0.4 * o.noise) +
                            o.dome * (1.0 - p.squaredNorm() / reach2);
      point.colour = camera.shoot(mean, sun, random);
      if (!holes.at(p.x(), p.y())) lines[line].push_back(point);
    }
  });
  return join(lines);
}

std::vector<SensedPoint> senseFromGround(const Canopy& canopy, const StripPose& strip,
                                         const SimulationOptions& options, std::uint64_t seed) {
  const UgvOptions& o = options.ugv;
  const Camera camera(Random::stream(seed, kUgvSalt), o.colour_noise);
  const Visibility visibility(canopy, strip, o.camera_height);
  const Drift drift(Random::stream(seed, 0xD71F), options.views.drift * o.length, o.length);
  const Holes holes(seed ^ 0xB3, o.holes);
  const SmoothNoise light(seed ^ 0xB1, 1.7);
  const Eigen::Matrix2d turn = rotation2(strip.heading);
  const int rows = static_cast<int>(o.length / o.spacing);
  const int cols = static_cast<int>(o.width / o.spacing);
  std::vector<std::vector<SensedPoint>> lines(static_cast<std::size_t>(rows));
  parallelFor(lines.size(), [&](std::size_t line) {
    Random random = Random::stream(seed ^ kUgvSalt, line);
    for (int k = 0; k < cols; ++k) {
      const Eigen::Vector2d local(
          (static_cast<double>(line) + random.uniform()) * o.spacing - 0.5 * o.length,
          (k + random.uniform()) * o.spacing - 0.5 * o.width);
      const double sideways = std::abs(local.y()) / (0.5 * o.width);
      const double lost = o.falloff * sideways * sideways;
      const double chance = random.uniform();
      const Eigen::Vector2d p = strip.centre + turn * local;
      const Eigen::Vector2d at = canopy.frame.cellOf(p);
      const int r = static_cast<int>(std::lround(at.y())),
                c = static_cast<int>(std::lround(at.x()));
      if (chance < lost || !canopy.height.contains(r, c)) continue;
      float z = canopy.height(r, c);
      if (!visibility.sees(p, z) || holes.at(p.x(), p.y())) continue;
      Colour colour = canopy.colour(r, c);
      // Where the surface steps down, the plant's side is seen as well: some points lie on it.
      const float below =
          std::min({z, canopy.height.contains(r + 2, c) ? canopy.height(r + 2, c) : z,
                    canopy.height.contains(r - 2, c) ? canopy.height(r - 2, c) : z,
                    canopy.height.contains(r, c + 2) ? canopy.height(r, c + 2) : z,
                    canopy.height.contains(r, c - 2) ? canopy.height(r, c - 2) : z});
      if (z - below > 0.02F && random.chance(0.4)) {
        const auto down = static_cast<float>(random.uniform(0.0, 0.7));
        z -= down * (z - below);
        for (float& v : colour) v *= 1.0F - 0.35F * down;
      }
      SensedPoint point;
      point.truth = {p.x(), p.y(), static_cast<double>(z)};
      // Noise moves a point for good; only the drift is for the registration to undo.
      for (int axis = 0; axis < 3; ++axis) point.truth[axis] += random.normal(o.noise);
      if (random.chance(o.outliers)) point.truth.z() += random.normal(0.3);
      const Eigen::Vector3d bend = drift.at(local.x());
      point.measured = point.truth;
      point.measured.head<2>() += turn * bend.head<2>();
      point.measured.z() += bend.z();
      const double sun = 1.0 + 0.15 * light.at(local.x(), 3.0) - 0.15 * sideways * sideways;
      point.colour = camera.shoot(colour, sun, random);
      lines[line].push_back(point);
    }
  });
  return join(lines);
}

}  // namespace agricolmap
