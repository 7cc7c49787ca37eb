// The kinds of pairs that a campaign measures, in suites: what is simulated, what the registration
// is told about its initial guess, and what it should reach.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/locate/association.hpp"
#include "agricolmap/simulate/simulation_options.hpp"
#include "campaign_summary.hpp"

namespace agricolmap::experiments {

enum class PairSource {
  kSimulated,   ///< SimulatedField
  kBeetMosaic,  ///< strips of a window of a real sugar-beet orthomosaic with made-up heights
  kBeetWhole,   ///< strips of all of its beets
  kSoybean,     ///< strips of a real orthomosaic with its surface model; both real
};

/// Values that an option of the simulation takes, drawn anew for each field or strip.
struct OptionRange {
  std::string path;  ///< of a number in SimulationOptions
  double low;
  double high;
  std::vector<double> values = {};  ///< one of these instead of low…high
};

struct Case {
  std::string name;
  PairSource source = PairSource::kSimulated;
  simulate::SimulationOptions options;
  /// Drawn over `options`: what the drone's view depends on for each field, the rest for each
  /// strip.
  std::vector<OptionRange> ranges;
  Target target;
  int max_pairs = 0;         ///< 0: as many as the campaign asks for
  int strips_per_field = 1;  ///< so many consecutive seeds share a field and the drone's view of it
  /// What the registration is told of the guess; nothing: its own default, the paper's.
  std::optional<PriorUncertainty> prior;
  bool scale_unknown = false;  ///< the registration is told that the moving file's unit is unknown

  /// The seed of the field that the pair of this seed lies in, and the strip's number in it.
  int fieldSeed(int seed) const { return seed - seed % strips_per_field; }
  int stripOf(int seed) const { return seed % strips_per_field; }
  /// The simulation's options for the pair of this seed, ranges drawn.
  simulate::SimulationOptions optionsFor(int seed) const;
  /// Equal for pairs whose drone's clouds are the same to the bit.
  std::string flightText(int seed) const;
  /// All that distinguishes this case from others, to tell campaigns apart.
  std::string text() const;
};

/// "paper": the first campaign's; "locate": what locating must reach; "curves": one setting varied
/// at a time; "calibrate": what the verdict's probability is fitted to; "develop": locate's kinds
/// with other settings. docs/campaign-suites.md says which settings each has.
std::vector<std::string> suiteNames();
/// The cases of a suite, in the order of reports. `uniform`: errors of an initial guess uniform
/// from zero to the case's, instead of always as large. Throws UsageError for an unknown suite.
std::vector<Case> suiteCases(const std::string& suite, bool uniform);

}  // namespace agricolmap::experiments
