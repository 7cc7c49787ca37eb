#include "agricolmap/simulate/field/plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace agricolmap::simulate {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kGoldenAngle = 2.39996F;
constexpr double kMostGrowth = 1.6;  // of a plant over the field's
constexpr std::uint64_t kGrowthSalt = 61;

float normal(Random& random, double sigma) { return static_cast<float>(random.normal(sigma)); }
float uniform(Random& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

/// Height of a usual plant's top, for wind and light [m].
float usualHeight(Species species) {
  switch (species) {
    case Species::kSoybean:
      return 0.20F;
    case Species::kBeet:
      return 0.13F;
    case Species::kWheat:
      return 0.25F;
    case Species::kMaize:
      return 0.85F;
    case Species::kBroadWeed:
      return 0.05F;
    case Species::kGrassWeed:
      return 0.10F;
    case Species::kStraw:
    case Species::kStone:
      return 1.0F;
  }
  return 1.0F;
}

int leafCount(Species species, Random& random) {
  switch (species) {
    case Species::kSoybean:
      return 5 + static_cast<int>(random.below(4));
    case Species::kBeet:
      return 6 + static_cast<int>(random.below(6));
    case Species::kWheat:
      return 4 + static_cast<int>(random.below(3));
    case Species::kMaize:
      return 8 + static_cast<int>(random.below(3));
    case Species::kBroadWeed:
      return 4 + static_cast<int>(random.below(5));
    case Species::kGrassWeed:
      return 5 + static_cast<int>(random.below(6));
    case Species::kStraw:
    case Species::kStone:
      return 1;
  }
  return 0;
}

std::array<float, 3> usualAlbedo(Species species) {
  switch (species) {
    case Species::kSoybean:
      return {0.062F, 0.150F, 0.040F};
    case Species::kBeet:
      return {0.090F, 0.190F, 0.050F};
    case Species::kWheat:
      return {0.075F, 0.140F, 0.050F};
    case Species::kMaize:
      return {0.080F, 0.165F, 0.048F};
    case Species::kBroadWeed:
      return {0.085F, 0.165F, 0.055F};
    case Species::kGrassWeed:
      return {0.095F, 0.185F, 0.060F};
    case Species::kStraw:
      return {0.420F, 0.360F, 0.260F};
    case Species::kStone:
      return {0.450F, 0.430F, 0.390F};
  }
  return {};
}

Leaf soybeanLeaf(Random& r, float order, float around) {
  Leaf leaf;
  leaf.shape = LeafShape::kTrifoliate;
  leaf.azimuth = around + normal(r, 0.5);
  leaf.elevation = uniform(r, 0.35, 1.0);
  leaf.bend = uniform(r, 0.3, 0.8);
  leaf.length = (0.6F + 0.5F * order) * uniform(r, 0.080, 0.125);
  leaf.stalk = 0.5F;
  leaf.width = 0.62F * 0.5F * leaf.length;
  leaf.base_z = 0.03F + 0.11F * order;
  leaf.roll = normal(r, 0.3);
  return leaf;
}

Leaf beetLeaf(Random& r, float order, float around) {
  Leaf leaf;
  leaf.azimuth = around + normal(r, 0.3);
  // Young leaves stand in the middle, old ones lie around them.
  leaf.elevation = 0.45F + 0.75F * order + normal(r, 0.15);
  leaf.bend = uniform(r, 0.5, 1.1);
  leaf.length = (1.0F - 0.45F * order) * uniform(r, 0.11, 0.17);
  leaf.stalk = uniform(r, 0.30, 0.42);
  leaf.width = 0.40F * leaf.length * uniform(r, 0.85, 1.15);
  leaf.base_z = 0.01F;
  leaf.roll = normal(r, 0.25);
  return leaf;
}

Leaf wheatLeaf(Random& r, float order, float around) {
  Leaf leaf;
  leaf.shape = LeafShape::kBlade;
  leaf.azimuth = around + normal(r, 1.0);
  leaf.elevation = uniform(r, 1.1, 1.5);
  leaf.bend = uniform(r, 0.2, 1.3);
  leaf.length = uniform(r, 0.10, 0.18);
  leaf.width = uniform(r, 0.008, 0.012);
  leaf.base_z = 0.02F + 0.09F * order;
  leaf.roll = normal(r, 0.4);
  return leaf;
}

Leaf maizeLeaf(Random& r, float order, float around, int index) {
  Leaf leaf;
  leaf.shape = LeafShape::kBlade;
  // Leaves stand in two ranks.
  leaf.azimuth = around + kPi * static_cast<float>(index % 2) + normal(r, 0.22);
  leaf.elevation = uniform(r, 0.8, 1.2) + 0.2F * order;
  leaf.bend = uniform(r, 1.2, 2.1) * (1.1F - 0.4F * order);
  leaf.length = uniform(r, 0.42, 0.58) * (0.55F + 1.6F * order * (1.15F - order));
  leaf.width = uniform(r, 0.050, 0.068) * (0.7F + 0.3F * order);
  leaf.base_z = 0.05F + 0.50F * order;
  leaf.roll = normal(r, 0.2);
  return leaf;
}

Leaf weedLeaf(Random& r, Species species, float around) {
  Leaf leaf;
  leaf.azimuth = around + normal(r, 0.5);
  if (species == Species::kBroadWeed) {
    leaf.elevation = uniform(r, 0.1, 0.7);
    leaf.bend = uniform(r, 0.1, 0.6);
    leaf.length = uniform(r, 0.03, 0.08);
    leaf.stalk = 0.25F;
    leaf.width = uniform(r, 0.3, 0.6) * leaf.length;
    leaf.base_z = uniform(r, 0.005, 0.02);
  } else {
    leaf.shape = LeafShape::kBlade;
    leaf.elevation = uniform(r, 0.5, 1.4);
    leaf.bend = uniform(r, 0.5, 1.6);
    leaf.length = uniform(r, 0.07, 0.14);
    leaf.width = uniform(r, 0.005, 0.008);
    leaf.base_z = 0.005F;
  }
  return leaf;
}

Leaf strawPiece(Random& r) {
  Leaf leaf;
  leaf.shape = LeafShape::kStraw;
  leaf.azimuth = uniform(r, 0.0, 2.0 * std::numbers::pi);
  leaf.elevation = normal(r, 0.06);
  leaf.length = uniform(r, 0.04, 0.16);
  leaf.width = uniform(r, 0.004, 0.010);
  leaf.base_z = uniform(r, 0.003, 0.012);
  return leaf;
}

/// A pebble: an oval that arches over the soil.
Leaf stone(Random& r) {
  Leaf leaf;
  leaf.azimuth = uniform(r, 0.0, 2.0 * std::numbers::pi);
  leaf.elevation = 0.6F;
  leaf.bend = 1.2F;
  leaf.length = uniform(r, 0.012, 0.04);
  leaf.width = uniform(r, 0.6, 0.95) * leaf.length;
  leaf.base_z = 0.002F;
  return leaf;
}

Leaf drawLeaf(Species species, Random& random, int index, int count, float phase) {
  const float order = static_cast<float>(index + 1) / static_cast<float>(count);
  const float around = phase + kGoldenAngle * static_cast<float>(index);
  switch (species) {
    case Species::kSoybean:
      return soybeanLeaf(random, order, around);
    case Species::kBeet:
      return beetLeaf(random, order, around);
    case Species::kWheat:
      return wheatLeaf(random, order, around);
    case Species::kMaize:
      return maizeLeaf(random, order, phase, index);
    case Species::kBroadWeed:
    case Species::kGrassWeed:
      return weedLeaf(random, species, around);
    case Species::kStraw:
      return strawPiece(random);
    case Species::kStone:
      return stone(random);
  }
  return {};
}

/// Growth of a plant over the field's.
double ownGrowth(const Plant& plant, double spread) {
  if (spread <= 0.0) return 1.0;
  Random random(hashBits(plant.id, kGrowthSalt));
  return std::clamp(std::exp(random.normal(spread)), 1.0 / kMostGrowth, kMostGrowth);
}

/// How far a leaf has turned: the lower ones first, each in a time of its own.
float ripenessOf(const Plant& plant, const VisitPlants& visit, std::uint64_t leaf, float order) {
  if (visit.ripeness <= 0.0 || !grows(plant.species) || isWeed(plant.species)) return 0.0F;
  const float turns = 0.3F * order + 0.45F * hashUniform(leaf, 1, 5);
  return std::max(0.0F, static_cast<float>(visit.ripeness) + plant.ripeness - turns);
}

}  // namespace

double VisitPlants::reach() const {
  // No plant is higher than one and a half times its reach.
  return std::max(1.0, growth) * (growth_spread > 0.0 ? kMostGrowth : 1.0) *
         (1.0 + 1.5 * lean.norm());
}

std::array<float, 3> Foliage::albedoOf(const Leaf& leaf) const {
  constexpr std::array<float, 3> kYellow = {0.54F, 0.45F, 0.06F};
  constexpr std::array<float, 3> kBrown = {0.21F, 0.15F, 0.09F};
  const float yellow = std::clamp(4.0F * leaf.ripe, 0.0F, 1.0F);
  const float brown = std::clamp(4.0F * leaf.ripe - 4.0F, 0.0F, 1.0F);
  std::array<float, 3> mixed = albedo;
  for (std::size_t k = 0; k < 3; ++k) {
    mixed[k] += yellow * (kYellow[k] - mixed[k]);
    mixed[k] += brown * (kBrown[k] - mixed[k]);
    mixed[k] *= leaf.shade;
  }
  return mixed;
}

Foliage growFoliage(const Plant& plant, const VisitPlants& visit) {
  Random shared(plant.id);
  Random visitor(hashBits(visit.seed, plant.id));
  Foliage foliage;
  foliage.count = leafCount(plant.species, shared);
  const float phase = uniform(shared, 0.0, 2.0 * std::numbers::pi);
  const bool alive = grows(plant.species);
  const double growth = alive ? visit.growth * ownGrowth(plant, visit.growth_spread) : 1.0;
  const float size = plant.size * static_cast<float>(growth);
  const float height = usualHeight(plant.species) * size;
  const Eigen::Vector2f sway(normal(visitor, visit.wind), normal(visitor, visit.wind));
  for (int i = 0; i < foliage.count; ++i) {
    const std::uint64_t leaf_seed = shared.bits();
    const bool redrawn = alive && shared.chance(visit.leaf_unshared);
    Random own = redrawn ? Random::stream(visit.seed, leaf_seed) : Random(leaf_seed);
    // A leaf drawn anew may point anywhere: it stands for another one that this view sees.
    const float turned = redrawn && plant.species != Species::kMaize
                             ? uniform(own, 0.0, 2.0 * std::numbers::pi)
                             : phase;
    Leaf leaf = drawLeaf(plant.species, own, i, foliage.count, turned);
    const float age = normal(own, 0.10);
    const float order = static_cast<float>(i + 1) / static_cast<float>(foliage.count);
    leaf.ripe = ripenessOf(plant, visit, leaf_seed, order);
    // Dry leaves shrivel.
    leaf.width *= 1.0F - 0.6F * std::clamp(leaf.ripe - 1.0F, 0.0F, 1.0F);
    leaf.length *= size;
    leaf.width *= size;
    leaf.base_z *= size;
    const float top = leaf.base_z + 0.6F * leaf.length * std::sin(std::max(0.1F, leaf.elevation));
    // Leaves deep in the stand get less light and are darker themselves.
    leaf.shade = std::clamp(0.62F + 0.38F * std::min(1.3F, top / height) + age, 0.4F, 1.3F);
    const float flutter = 0.4F * static_cast<float>(visit.wind);
    leaf.shift = std::min(1.0F, top / height) *
                 (sway + flutter * Eigen::Vector2f(normal(visitor, 1.0), normal(visitor, 1.0)));
    if (alive) leaf.shift += top * visit.lean.cast<float>();
    foliage.leaves[static_cast<std::size_t>(i)] = leaf;
  }
  foliage.albedo = usualAlbedo(plant.species);
  const float tone = std::clamp(plant.tone, -1.5F, 1.5F);
  // Positive tones are lighter and yellower.
  foliage.albedo[0] *= std::exp(0.22F * tone);
  foliage.albedo[1] *= std::exp(0.13F * tone);
  foliage.albedo[2] *= std::exp(0.05F * tone);
  for (float& a : foliage.albedo) a *= plant.brightness;
  return foliage;
}

}  // namespace agricolmap::simulate
