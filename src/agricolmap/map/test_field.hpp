// Fields for tests: rows of plants of several leaves, seen twice with independent noise, and smooth
// texture.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::testing {

struct TestField {
  double size = 16.0;           ///< side of the field [m]
  double rows = 0.45;           ///< between rows [m]
  double plants = 0.20;         ///< between plants of a row [m]
  double leaf = 0.025;          ///< deviation of a leaf [m]
  double gaps = 0.12;           ///< share of missing plants
  double noise = 0.03;          ///< of ExG in a view
  double height_noise = 0.004;  ///< [m]
  double other_leaves =
      0.0;                 ///< share of leaves that a view with its own `leaf_seed` sees elsewhere
  std::uint64_t seed = 1;  ///< of the plants
  std::uint64_t leaf_seed = 1;  ///< of the leaves not shared
};

/// Truth at 1 cm: greenness (0–1) and height [m].
struct Truth {
  Raster<float> green;
  Raster<float> height;
  static constexpr double kCell = 0.01;

  float sample(const Raster<float>& raster, const Eigen::Vector2d& p) const {
    const int col = static_cast<int>(std::floor(p.x() / kCell));
    const int row = static_cast<int>(std::floor(p.y() / kCell));
    return raster.contains(row, col) ? raster(row, col) : 0.0F;
  }
};

inline void addLeaf(Truth& truth, const Eigen::Vector2d& at, double sigma, double tall) {
  const int reach = static_cast<int>(3.0 * sigma / Truth::kCell);
  const int row0 = static_cast<int>(at.y() / Truth::kCell);
  const int col0 = static_cast<int>(at.x() / Truth::kCell);
  for (int row = row0 - reach; row <= row0 + reach; ++row) {
    for (int col = col0 - reach; col <= col0 + reach; ++col) {
      if (!truth.green.contains(row, col)) continue;
      const Eigen::Vector2d p = Truth::kCell * Eigen::Vector2d(col + 0.5, row + 0.5);
      const double value = std::exp(-0.5 * (p - at).squaredNorm() / (sigma * sigma));
      truth.green(row, col) = std::max(truth.green(row, col), static_cast<float>(value));
      truth.height(row, col) = std::max(truth.height(row, col), static_cast<float>(tall * value));
    }
  }
}

inline Truth growField(const TestField& field) {
  const int n = static_cast<int>(field.size / Truth::kCell);
  Truth truth{Raster<float>(n, n), Raster<float>(n, n)};
  Random random(field.seed);
  Random own = Random::stream(field.leaf_seed, 1);
  for (double y = 0.5 * field.rows; y < field.size; y += field.rows) {
    for (double x = 0.0; x < field.size; x += field.plants) {
      if (random.chance(field.gaps)) continue;
      const Eigen::Vector2d plant(x + random.normal(0.25 * field.plants), y + random.normal(0.02));
      const double vigour = random.uniform(0.6, 1.2);
      for (int leaf = 0; leaf < 5; ++leaf) {
        double angle = random.uniform(0.0, 6.2831853);
        double arm = vigour * random.uniform(0.0, 0.06);
        if (own.chance(field.other_leaves)) {
          angle = own.uniform(0.0, 6.2831853);
          arm = vigour * own.uniform(0.0, 0.06);
        }
        addLeaf(truth, plant + arm * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                vigour * field.leaf, 0.08 * vigour);
      }
    }
  }
  return truth;
}

/// The cells whose centre, moved by `field_from_view`, see the truth; others of `window` too when
/// they lie in the field, else they are empty. `holes` is the share of cells left empty.
inline map::GridMap viewOf(const Truth& truth, const TestField& field, const map::Box2& window,
                           const Eigen::Affine2d& field_from_view, double holes,
                           std::uint64_t seed) {
  map::GridMap map;
  map.frame.cell = 0.02;
  map.frame.corner = (window.min() / 0.02).array().floor() * 0.02;
  map.frame.cols = static_cast<int>(std::lround(window.sizes().x() / 0.02));
  map.frame.rows = static_cast<int>(std::lround(window.sizes().y() / 0.02));
  map.weight = Raster<float>(map.frame.rows, map.frame.cols);
  map.height = map.weight;
  map.exg = map.weight;
  map.colour = Raster<Rgb>(map.frame.rows, map.frame.cols);
  Random random(seed);
  for (int row = 0; row < map.frame.rows; ++row) {
    for (int col = 0; col < map.frame.cols; ++col) {
      const Eigen::Vector2d p = field_from_view * map.frame.centre(row, col);
      if ((p.array() < 0.0).any() || (p.array() >= field.size).any()) continue;
      if (random.chance(holes)) continue;
      const std::size_t i = map.weight.index(row, col);
      map.weight[i] = 1.0F;
      const float green = truth.sample(truth.green, p);
      map.exg[i] = green + static_cast<float>(random.normal(field.noise));
      map.height[i] =
          truth.sample(truth.height, p) + static_cast<float>(random.normal(field.height_noise));
      const auto level = [&](float value) {
        return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
      };
      map.colour[i] = {level(120.0F - 60.0F * green), level(100.0F + 60.0F * green),
                       level(80.0F - 40.0F * green)};
      ++map.filled;
    }
  }
  return map;
}

/// Smooth bumps and dents at random places of a box: a texture that cells of any size can sample.
class BumpField {
 public:
  /// `least` and `most`: size of a bump, its deviation [m].
  BumpField(std::uint64_t seed, int count, const map::Box2& box, double least, double most) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      const double x = random.uniform(box.min().x(), box.max().x());
      const double y = random.uniform(box.min().y(), box.max().y());
      const double size = random.uniform(least, most);
      bumps_.push_back({{x, y}, size, random.normal()});
    }
  }
  float at(const Eigen::Vector2d& p) const {
    double sum = 0.0;
    for (const Bump& bump : bumps_) {
      const double d2 = (p - bump.at).squaredNorm() / (bump.size * bump.size);
      if (d2 < 12.0) sum += bump.height * std::exp(-0.5 * d2);
    }
    return static_cast<float>(sum);
  }

 private:
  struct Bump {
    Eigen::Vector2d at;
    double size;
    double height;
  };
  std::vector<Bump> bumps_;
};

/// A signal map that shows `value(point)` as greenness and, half as strong, as height.
template <typename Value>
map::SignalMap signalOf(const GridFrame& frame, const Value& value) {
  map::SignalMap map;
  map.frame = frame;
  map.weight = Raster<float>(frame.rows, frame.cols, 1.0F);
  for (auto& channel : map.channel) channel = Raster<float>(frame.rows, frame.cols);
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 0; col < frame.cols; ++col) {
      map.channel[0](row, col) = static_cast<float>(value(frame.centre(row, col)));
      map.channel[1](row, col) = 0.5F * map.channel[0](row, col);
    }
  }
  map.deviation[map::kGreenChannel] = map.deviation[map::kHeightChannel] = 1.0;
  return map;
}

/// An affine about `centre` as the initial guess is wrong by.
inline Eigen::Affine2d guessError(const Eigen::Vector2d& centre, const Eigen::Vector2d& shift,
                                  double yaw, double scale_x, double scale_y) {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  pose.linear() = rotation2(yaw) * Eigen::Vector2d(scale_x, scale_y).asDiagonal();
  pose.translation() = centre + shift - pose.linear() * centre;
  return pose;
}

}  // namespace agricolmap::testing
