// The field: where plants, weeds and straw lie and how high the soil is, anywhere in the plane.
// Everything follows from the seed and the place, so windows of any size and angle agree.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "agricolmap/simulate/field/canvas.hpp"
#include "agricolmap/simulate/field/noise.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

enum class Species : std::uint8_t {
  kSoybean,
  kBeet,
  kWheat,
  kMaize,
  kBroadWeed,
  kGrassWeed,
  kStraw,
  kStone,
};
inline bool isWeed(Species species) {
  return species == Species::kBroadWeed || species == Species::kGrassWeed;
}
/// Neither straw nor stone.
inline bool grows(Species species) {
  return species != Species::kStraw && species != Species::kStone;
}

/// One plant (or piece of straw, or stone) and what is the same in both views.
struct Plant {
  Eigen::Vector2f position;  ///< field frame [m]
  float size = 1.0F;         ///< factor on the species' usual size
  float tone = 0.0F;         ///< about −1…1: darker or more yellow than usual
  float ripeness = 0.0F;     ///< how much riper than the field, see ViewOptions::ripeness
  float brightness = 1.0F;   ///< factor on its reflectance
  std::uint64_t id = 0;      ///< seed of what is drawn for it
  std::int64_t row = 0;      ///< of a sown plant, counted from the field's middle
  Species species = Species::kSoybean;
};

/// How far a plant of size 1 reaches from its place [m].
double reachOf(Species species);
Species speciesOf(Crop crop);
/// How deep the leaves of a stand lie one above the other where they do: what hides the ground from
/// a low camera [m].
float leafDepthOf(Species species);

class FieldModel {
 public:
  FieldModel(Crop crop, const FieldOptions& options, std::uint64_t seed);

  Species species() const { return species_; }
  double rowHeading() const { return heading_; }
  const FieldOptions& options() const { return options_; }
  std::uint64_t seed() const { return seed_; }

  /// All plants whose leaves may reach into the window, when they reach up to `reach` times as far
  /// as usual for their size.
  std::vector<Plant> plantsIn(const Window& window, double reach) const;

  /// Coordinates along and across the rows [m].
  Eigen::Vector2d rowCoordinates(const Eigen::Vector2d& point) const;
  /// Height of the soil without clods [m].
  double soilHeight(const Eigen::Vector2d& point) const;
  /// 0 outside wheel tracks, 1 in their middle; by coordinate across the rows.
  float wheelTrack(double across) const;

 private:
  void addRows(const Window& window, double margin, std::vector<Plant>& plants) const;
  void addScattered(const Window& window, double margin, std::vector<Plant>& plants) const;
  /// A crop and the distance of its plants along the row [m].
  struct Sown {
    Species species;
    double spacing;
  };
  /// The part of the field that a place lies in.
  struct Plot {
    bool bare = false;
    Species species = Species::kSoybean;
    float size = 1.0F;  ///< factor
    float tone = 0.0F;
    float ripeness = 0.0F;
  };
  void addRow(std::int64_t row, const Sown& sown, double u_min, double u_max, const Window& window,
              double margin, std::vector<Plant>& plants) const;
  Plot plotAt(std::int64_t row, double along) const;
  double terraceHeight(double along) const;
  bool missing(std::int64_t row, std::int64_t index, double u) const;

  Species species_;
  std::vector<Sown> sown_;  ///< all crops of the field, the usual one first
  FieldOptions options_;
  std::uint64_t seed_;
  double heading_;
  double track_offset_;
  Eigen::Vector2d slope_;
};

}  // namespace agricolmap::simulate
