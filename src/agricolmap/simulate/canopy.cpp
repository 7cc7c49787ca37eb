#include "agricolmap/simulate/canopy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// Direction to the sun at the time of a view: morning for the UAV, `sun_hours` later for the UGV.
Eigen::Vector3d sunDirection(const Scene& scene, View view) {
  Random random = Random::stream(scene.seed(), 0x99);
  const double hours = view == View::kUgv ? scene.options().views.sun_hours : 0.0;
  const double azimuth = random.uniform(0.0, 2.0 * std::numbers::pi) - 15.0 * kRadians * hours;
  const double elevation = (random.uniform(38.0, 58.0) + 4.0 * hours) * kRadians;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// One leaf: a curved strip that rises from the stem and droops.
struct Leaf {
  double azimuth, length, width, elevation, droop, start_height;
  Colour colour;
};

Leaf drawLeaf(const SimulationOptions& o, const Plant& plant, Random random, double size) {
  const FieldOptions& f = o.field;
  Leaf leaf{};
  leaf.azimuth = random.uniform(0.0, 2.0 * std::numbers::pi);
  leaf.length = f.leaf_length * size * random.uniform(0.65, 1.2);
  leaf.width =
      f.leaf_width * std::sqrt(size) * random.uniform(0.75, 1.2) * (plant.weed ? 0.7 : 1.0);
  leaf.elevation = (f.leaf_elevation_deg + random.normal(14.0)) * kRadians;
  leaf.droop = f.leaf_droop_deg * random.uniform(0.6, 1.3) * kRadians;
  // Leaves sit along the stem; what they rise by themselves is not counted twice.
  const double rise =
      leaf.length * std::sin(std::clamp(leaf.elevation - 0.4 * leaf.droop, 0.0, 1.5));
  leaf.start_height = std::max(0.0, f.plant_height * size * random.uniform(0.25, 1.0) - 0.6 * rise);
  const auto tone = static_cast<float>(random.uniform(0.8, 1.15));
  const auto yellow = static_cast<float>(random.uniform(-0.03, 0.06));
  leaf.colour = plant.weed ? Colour{tone * (0.20F + yellow), tone * 0.42F, tone * 0.10F}
                           : Colour{tone * (0.15F + yellow), tone * 0.36F, tone * 0.11F};
  return leaf;
}

/// Draws leaves into rows [first, last) of the canopy.
class LeafPainter {
 public:
  LeafPainter(Canopy& canopy, const Eigen::Vector3d& sun, int first, int last)
      : canopy_(canopy), sun_(sun), first_(first), last_(last) {}

  /// `sway`: displacement of the plant's top; `top`: its height.
  void paint(const Leaf& leaf, const Eigen::Vector2d& foot, double foot_height,
             const Eigen::Vector2d& sway, double top) {
    const double cell = canopy_.frame.cell;
    const Eigen::Vector2d direction(std::cos(leaf.azimuth), std::sin(leaf.azimuth));
    const Eigen::Vector2d side(-direction.y(), direction.x());
    const int steps = std::max(3, static_cast<int>(std::ceil(leaf.length / (0.8 * cell))));
    double reach = 0.0, height = leaf.start_height;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const double slope = leaf.elevation - leaf.droop * t;
      reach += std::cos(slope) * leaf.length / steps;
      height += std::sin(slope) * leaf.length / steps;
      const double z = foot_height + std::max(0.0, height);
      const Eigen::Vector2d lean = sway * std::clamp(height / top, 0.0, 1.3);
      const Eigen::Vector2d middle = foot + direction * reach + lean;
      const double half =
          0.5 * leaf.width * std::sin(std::numbers::pi * std::pow(0.08 + 0.92 * t, 0.75));
      const int across = static_cast<int>(std::ceil(half / (0.8 * cell)));
      // Lambert's law for the leaf's upper side, both sides lit a little.
      const Eigen::Vector3d normal(-std::sin(slope) * direction.x(),
                                   -std::sin(slope) * direction.y(), std::cos(slope));
      const auto light = static_cast<float>(0.55 + 0.6 * std::max(0.0, normal.dot(sun_)));
      for (int k = -across; k <= across; ++k) {
        const double v = across == 0 ? 0.0 : half * k / across;
        const float rib = std::abs(v) < 0.08 * leaf.width ? 1.12F : 1.0F;
        dot(middle + side * v, z, light * rib, leaf.colour);
      }
    }
  }

 private:
  void dot(const Eigen::Vector2d& p, double z, float light, const Colour& colour) {
    const Eigen::Vector2d at = (p - canopy_.frame.corner) / canopy_.frame.cell;
    const int row = static_cast<int>(std::floor(at.y()));
    const int col = static_cast<int>(std::floor(at.x()));
    if (row < first_ || row >= last_ || col < 0 || col >= canopy_.frame.cols) return;
    const std::size_t i = canopy_.height.index(row, col);
    if (static_cast<float>(z) <= canopy_.height[i]) return;
    canopy_.height[i] = static_cast<float>(z);
    canopy_.colour[i] = {colour[0] * light, colour[1] * light, colour[2] * light};
  }
  Canopy& canopy_;
  const Eigen::Vector3d sun_;
  int first_;
  int last_;
};

void paintPlant(const Scene& scene, View view, const Plant& plant, LeafPainter& painter) {
  const SimulationOptions& o = scene.options();
  const bool later = view == View::kUgv;
  Random own = Random::stream(scene.seed() ^ 0xAB, plant.id);
  const bool pulled = own.chance(o.views.weeds_pulled);
  if (plant.weed && later && pulled) return;
  const double size = plant.size * (later ? o.views.growth : 1.0);
  Random breeze = Random::stream(scene.seed() ^ (later ? 0xC1 : 0xC0), plant.id);
  const Eigen::Vector2d sway(breeze.normal(o.views.wind), breeze.normal(o.views.wind));
  const double foot_height = scene.ground(plant.foot.x(), plant.foot.y());
  const double top = o.field.plant_height * size;
  const int leaves =
      std::max(2, static_cast<int>(std::lround(o.field.leaves * std::sqrt(plant.size))));
  for (int i = 0; i < leaves; ++i) {
    const std::uint64_t key = plant.id * 131 + static_cast<std::uint64_t>(i);
    const bool unshared = Random::stream(scene.seed() ^ 0xD0, key).chance(o.views.leaf_unshared);
    const std::uint64_t salt = unshared && later ? 0xE1 : 0xE0;
    painter.paint(drawLeaf(o, plant, Random::stream(scene.seed() ^ salt, key), size), plant.foot,
                  foot_height, sway, top);
  }
}

/// Soil: relief, clods and a speckle of which a share differs between the views.
void paintSoil(const Scene& scene, View view, Canopy& canopy) {
  const SimulationOptions& o = scene.options();
  const std::uint64_t seed = scene.seed();
  const SmoothNoise coarse(seed ^ 0x31, 0.05), fine(seed ^ 0x32, 0.018), patches(seed ^ 0x33, 2.5);
  const std::uint64_t own_salt = view == View::kUgv ? 0x41 : 0x42;
  const SmoothNoise own(seed ^ own_salt, 0.03);
  const double unshared = o.views.leaf_unshared;
  const double keep = std::sqrt(1.0 - unshared), change = std::sqrt(unshared);
  parallelFor(static_cast<std::size_t>(canopy.frame.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < canopy.frame.cols; ++c) {
      const Eigen::Vector2d p = canopy.frame.centre(r, c);
      const std::size_t i = canopy.height.index(r, c);
      const double clod = coarse.at(p.x(), p.y()) + 0.6 * fine.at(p.x(), p.y());
      canopy.ground[i] =
          static_cast<float>(scene.ground(p.x(), p.y()) + 1.6 * o.field.clods * clod);
      canopy.height[i] = canopy.ground[i];
      const double speckle = keep * clod + change * 1.1 * own.at(p.x(), p.y());
      const auto tone = static_cast<float>(1.0 + 0.16 * speckle + 0.12 * patches.at(p.x(), p.y()));
      canopy.colour[i] = {0.42F * tone, 0.345F * tone, 0.27F * tone};
    }
  });
}

/// Cells whose way to the sun is blocked lose its light and turn bluish.
void castShadows(const Eigen::Vector3d& sun, Canopy& canopy) {
  const double cell = canopy.frame.cell;
  const float tallest = *std::max_element(canopy.height.begin(), canopy.height.end());
  const double stride = std::max(1.0, 0.012 / cell);
  const Eigen::Vector2d step = stride * sun.head<2>().normalized();
  const auto rise = static_cast<float>(stride * cell * sun.z() / sun.head<2>().norm());
  Raster<unsigned char> shaded(canopy.frame.rows, canopy.frame.cols);
  parallelFor(static_cast<std::size_t>(canopy.frame.rows), [&](std::size_t row) {
    for (int c = 0; c < canopy.frame.cols; ++c) {
      const int r = static_cast<int>(row);
      float ray = canopy.height(r, c) + 0.01F;
      double x = c, y = r;
      while (ray < tallest) {
        x += step.x();
        y += step.y();
        ray += rise;
        const int rr = static_cast<int>(std::lround(y)), cc = static_cast<int>(std::lround(x));
        if (!canopy.height.contains(rr, cc)) break;
        if (canopy.height(rr, cc) > ray) {
          shaded(r, c) = 1;
          break;
        }
      }
    }
  });
  for (std::size_t i = 0; i < shaded.size(); ++i) {
    if (shaded[i] == 0) continue;
    Colour& colour = canopy.colour[i];
    colour = {0.42F * colour[0], 0.46F * colour[1], 0.55F * colour[2]};
  }
}

}  // namespace

Canopy renderCanopy(const Scene& scene, View view, const Eigen::AlignedBox2d& window, double cell) {
  Canopy canopy;
  canopy.frame.corner = window.min();
  canopy.frame.cell = cell;
  canopy.frame.cols = static_cast<int>(std::ceil(window.sizes().x() / cell));
  canopy.frame.rows = static_cast<int>(std::ceil(window.sizes().y() / cell));
  canopy.ground = Raster<float>(canopy.frame.rows, canopy.frame.cols);
  canopy.height = Raster<float>(canopy.frame.rows, canopy.frame.cols);
  canopy.colour = Raster<Colour>(canopy.frame.rows, canopy.frame.cols);
  paintSoil(scene, view, canopy);
  const Eigen::Vector3d sun = sunDirection(scene, view);
  // Bands of rows in parallel; every band looks at all plants that can reach into it.
  const double reach = scene.options().field.leaf_length * 2.0 * scene.options().views.growth + 0.1;
  constexpr int kBand = 200;
  const auto bands = static_cast<std::size_t>((canopy.frame.rows + kBand - 1) / kBand);
  std::vector<std::vector<const Plant*>> members(bands);
  for (const Plant& plant : scene.plants()) {
    if (plant.foot.x() < window.min().x() - reach || plant.foot.x() > window.max().x() + reach) {
      continue;
    }
    const double low = (plant.foot.y() - reach - window.min().y()) / (kBand * cell);
    const double high = (plant.foot.y() + reach - window.min().y()) / (kBand * cell);
    const int first = std::max(0, static_cast<int>(std::floor(low)));
    const int last = std::min(static_cast<int>(bands) - 1, static_cast<int>(std::floor(high)));
    for (int b = first; b <= last; ++b) members[static_cast<std::size_t>(b)].push_back(&plant);
  }
  parallelFor(bands, [&](std::size_t b) {
    const int first = static_cast<int>(b) * kBand;
    LeafPainter painter(canopy, sun, first, std::min(first + kBand, canopy.frame.rows));
    for (const Plant* plant : members[b]) paintPlant(scene, view, *plant, painter);
  });
  castShadows(sun, canopy);
  return canopy;
}

}  // namespace agricolmap
