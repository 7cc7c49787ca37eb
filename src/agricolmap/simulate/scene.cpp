#include "agricolmap/simulate/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "agricolmap/core/transform.hpp"

namespace agricolmap {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

double rowHeadingOf(const SimulationOptions& options, std::uint64_t seed) {
  if (options.field.row_heading_deg >= 0.0) return options.field.row_heading_deg * kRadians;
  return Random::stream(seed, 11).uniform(0.0, 2.0 * std::numbers::pi);
}

}  // namespace

Scene::Scene(const SimulationOptions& options, std::uint64_t seed)
    : options_(options),
      seed_(seed),
      row_heading_(rowHeadingOf(options, seed)),
      relief_(seed ^ 0x51, 6.0),
      fine_relief_(seed ^ 0x52, 1.3) {
  plantRows();
  sowWeeds();
}

Eigen::AlignedBox2d Scene::extent() const {
  const Eigen::Vector2d half(0.5 * options_.field.width, 0.5 * options_.field.height);
  return {-half, half};
}

double Scene::ground(double x, double y) const {
  const Eigen::Vector2d row = rotation2(-row_heading_) * Eigen::Vector2d(x, y);
  const double ridge = std::cos(2.0 * std::numbers::pi * row.y() / options_.field.row_spacing);
  return options_.field.relief * (relief_.at(x, y) + 0.3 * fine_relief_.at(x, y)) +
         options_.field.furrow * ridge;
}

void Scene::plantRows() {
  const FieldOptions& f = options_.field;
  const double reach = 0.5 * std::hypot(f.width, f.height) + 1.0;
  const Eigen::AlignedBox2d box = extent();
  const int rows = static_cast<int>(std::ceil(reach / f.row_spacing));
  const SmoothNoise wobble(seed_ ^ 0x61, 7.0);
  const SmoothNoise growth(seed_ ^ 0x62, 8.0);
  const SmoothNoise gap_clusters(seed_ ^ 0x63, 0.8);
  const Eigen::Matrix2d turn = rotation2(row_heading_);
  for (int row = -rows; row <= rows; ++row) {
    Random random = Random::stream(seed_ ^ 0x70, static_cast<std::uint64_t>(row + rows));
    double along = -reach + random.uniform(0.0, f.plant_spacing);
    const double row_offset = random.normal(0.01);
    std::uint64_t number = 0;
    while (along < reach) {
      along += f.plant_spacing * std::max(0.2, 1.0 + random.normal(f.spacing_jitter));
      ++number;
      // Drawn for every place, so that gaps do not shift what follows.
      const double across_jitter = random.normal(std::min(0.015, 0.1 * f.row_spacing));
      const double chance = random.uniform();
      const double size_draw = random.normal(f.size_variation);
      const double across =
          row * f.row_spacing + row_offset + across_jitter + f.row_wobble * wobble.at(along, 50.0);
      const Eigen::Vector2d foot = turn * Eigen::Vector2d(along, across);
      if (!box.contains(foot)) continue;
      // Gaps come in clusters: a smooth field modulates their chance, its mean stays.
      const double cluster = 1.0 + gap_clusters.at(foot.x(), foot.y());
      if (chance < f.gaps * cluster * cluster / 1.2) continue;
      if (f.tramline > 0.0) {
        const double track = std::abs(std::remainder(across, f.tramline));
        if (std::abs(track - 0.9) < 0.15) continue;
      }
      Plant plant;
      plant.id = (static_cast<std::uint64_t>(row + rows) << 32) + number;
      plant.foot = foot;
      plant.size = std::clamp(
          (1.0 + size_draw) * (1.0 + f.growth_gradient * growth.at(foot.x(), foot.y())), 0.3, 2.0);
      plants_.push_back(plant);
    }
  }
}

void Scene::sowWeeds() {
  const FieldOptions& f = options_.field;
  Random random = Random::stream(seed_, 0x77);
  const SmoothNoise patches(seed_ ^ 0x78, 3.0);
  const auto count = static_cast<std::uint64_t>(f.weeds * f.width * f.height);
  const Eigen::AlignedBox2d box = extent();
  for (std::uint64_t i = 0; i < count; ++i) {
    Plant weed;
    weed.foot = {random.uniform(box.min().x(), box.max().x()),
                 random.uniform(box.min().y(), box.max().y())};
    weed.size = random.uniform(0.15, 0.5);
    weed.weed = true;
    weed.id = (1ULL << 62) + i;
    if (patches.at(weed.foot.x(), weed.foot.y()) > -0.3) plants_.push_back(weed);
  }
}

}  // namespace agricolmap
