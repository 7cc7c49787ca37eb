// The kinds of pairs that are registered: what is simulated, cut from real imagery or read, and
// what methods are told about the initial guess.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/search_space.hpp"
#include "agricolmap/simulate/simulation_options.hpp"
#include "experiments/pairs/dates.hpp"
#include "experiments/pairs/slip.hpp"

namespace agricolmap::experiments {

enum class PairSource {
  kSimulated,       ///< SimulatedField
  kBeetMosaic,      ///< strips of a window of a real sugar-beet orthomosaic with made-up heights
  kBeetWhole,       ///< strips of all of its beets
  kSoybean,         ///< strips of a real orthomosaic with its surface model; both real
  kPublished,       ///< two real clouds, read from files
  kDates,           ///< strips of one flight over a real field on the map of another
  kOtherGenerator,  ///< files of a generator that is not the product's
};
/// "simulated", "semi-real" (strips of real imagery; the second sensor is simulated) or "real".
std::string kindOf(PairSource source);

/// Values that an option of the simulation takes, drawn anew for each field or strip.
struct OptionRange {
  std::string path;  ///< of a number in SimulationOptions
  double low;
  double high;
  std::vector<double> values = {};  ///< one of these instead of low…high
};

/// Two real clouds: a drone's and a row of a robot in it.
struct PublishedPair {
  std::filesystem::path fixed_cloud;
  std::filesystem::path moving_cloud;
  std::optional<std::filesystem::path> truth_file;
  /// What that file says, moving file → fixed file coordinates [m].
  std::optional<Eigen::Affine3d> true_fixed_from_moving;
};

struct Case {
  std::string name;
  std::string dataset;  ///< crop or imagery that it is of
  PairSource source = PairSource::kSimulated;
  simulate::SimulationOptions options = {};
  /// Drawn over `options`: what the drone's view depends on for each field, the rest for each
  /// strip.
  std::vector<OptionRange> ranges = {};
  double setting = 0.0;      ///< value of the option that the suite varies, if it does
  int max_pairs = 0;         ///< 0: as many as are asked for
  int strips_per_field = 1;  ///< so many consecutive seeds share a field and the drone's view of it
  /// What methods are told of the guess; by default the paper's.
  PriorUncertainty told = {};
  std::optional<PublishedPair> published = {};  ///< of kPublished: its only pair
  std::optional<DatePair> dates = {};           ///< of kDates
  std::string folder = {};  ///< of kOtherGenerator: of its pairs' folders, in that of shared data
  std::optional<Slip> slip = {};  ///< of kSimulated, where a part of the strip is displaced
  int first_strip = 0;            ///< the number of the strips of a field's first seed

  /// The seed of the field that the pair of this seed lies in, and the strip's number in it.
  int fieldSeed(int seed) const { return seed - seed % strips_per_field; }
  int stripOf(int seed) const { return first_strip + seed % strips_per_field; }
  /// The simulation's options for the pair of this seed, ranges drawn.
  simulate::SimulationOptions optionsFor(int seed) const;
  /// Equal for pairs whose drone's clouds are the same to the bit.
  std::string flightText(int seed) const;
  /// All that distinguishes its pairs from those of other cases. Of published ones the files' names
  /// and sizes and the truth, but not where they lie; throws InputError for a file that is gone.
  std::string text() const;
};

}  // namespace agricolmap::experiments
