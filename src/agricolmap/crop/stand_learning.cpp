#include "agricolmap/crop/stand_learning.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/core/robust.hpp"

namespace agricolmap::crop {

namespace {

constexpr std::size_t kLeastValleys = 100;
constexpr double kValleyPull = 0.1;  // of what is usual, against what the field has to say
constexpr int kNewtonRounds = 20;
// Of the share by which counts err, on fields of seeds 700 to 702 and of another generator.
constexpr double kLeastError = 0.006;
constexpr double kCompeting = 0.15;  // to a plant that other explanations have elsewhere
constexpr double kAstray = 0.25;     // to the rhythm's own deviation
constexpr double kCoarse = 0.1;      // to a cell of the map's as wide as a spacing

double logisticOf(double x) { return 1.0 / (1.0 + std::exp(-x)); }

/// Deviations of plants from the places of a rhythm, and of the rhythm itself. Where each plant
/// strays from its own place, a long step follows a short one; where each stands a step from the
/// one before, steps know nothing of one another.
void learnSteps(const std::vector<Chain>& rows, StandModel& model) {
  constexpr double kUsual = 0.6;  // farther off, it is another number of places
  double square = 0.0;
  double product = 0.0;
  std::size_t singles = 0;
  std::size_t pairs = 0;
  for (const Chain& row : rows) {
    double last = 1.0;
    for (std::size_t i = 1; i < row.plants.size(); ++i) {
      const double step = (row.plants[i].middle - row.plants[i - 1].middle) / model.distance - 1.0;
      const bool single = std::abs(step) < kUsual;
      if (single) {
        square += step * step;
        ++singles;
        if (std::abs(last) < kUsual) {
          product += step * last;
          ++pairs;
        }
      }
      last = step;
    }
  }
  if (pairs < 20) return;
  const double variance = square / static_cast<double>(singles);
  const double own = std::clamp(-product / static_cast<double>(pairs), 0.0, 0.5 * variance);
  model.jitter = std::clamp(std::sqrt(own), 0.05, 0.22);
  model.drift = std::clamp(std::sqrt(std::max(0.0, variance - 2.0 * own)), kLeastDrift, 0.3);
}

/// How readily valleys part plants on this field, by what all else says of them: what the rhythm
/// and the sizes of plants make of each, its own word taken out. Leaves of maize part as clearly as
/// beets do. That deep valleys part more than shallow ones is not asked anew: it would be said to
/// mean little wherever the rhythm is unsure.
void learnValleys(const std::vector<Chain>& rows, const std::vector<std::vector<Piece>>& pieces,
                  const StandModel& before, StandModel& model) {
  std::vector<std::pair<double, double>> samples;  // odds of its own, share by all else
  double mean = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i + 1 < pieces[r].size(); ++i) {
      const double share = std::clamp(rows[r].between[i], 1e-4, 1.0 - 1e-4);
      const double own = clearness(pieces[r][i], pieces[r][i + 1], before);
      samples.emplace_back(own - before.valley, logisticOf(std::log(share / (1.0 - share)) - own));
      mean += samples.back().second;
    }
  }
  if (samples.size() < kLeastValleys) return;
  mean /= static_cast<double>(samples.size());
  // How often valleys are between plants is in the rhythm already.
  const double base = std::log(mean / (1.0 - mean));
  const double pull = kValleyPull * static_cast<double>(samples.size());
  double valley = before.valley;
  for (int round = 0; round < kNewtonRounds; ++round) {
    double slope = pull * (StandModel().valley - valley);
    double bend = pull;
    for (const auto& [own, share] : samples) {
      const double p = logisticOf(valley + own + base);
      slope += share - p;
      bend += p * (1.0 - p);
    }
    valley += std::clamp(slope / bend, -1.0, 1.0);
  }
  model.valley = valley;
}

}  // namespace

StandModel relearnt(const std::vector<Chain>& rows, const std::vector<std::vector<Piece>>& pieces,
                    const StandModel& before) {
  constexpr std::size_t kEnough = 20;
  StandModel model = before;
  std::vector<double> areas;
  std::vector<double> asides;
  std::vector<double> steps;
  std::size_t missing = 0;
  std::size_t used = 0;
  std::size_t all = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    all += pieces[r].size();
    const std::vector<PlantGroup>& plants = rows[r].plants;
    for (std::size_t i = 0; i < plants.size(); ++i) {
      areas.push_back(std::log(plants[i].area));
      for (std::size_t k = plants[i].first; k <= plants[i].last; ++k) {
        asides.push_back(std::abs(pieces[r][k].aside));
      }
      used += plants[i].last - plants[i].first + 1;
      if (i == 0) continue;
      const double step = (plants[i].middle - plants[i - 1].middle) / before.distance;
      if (step < 1.5) steps.push_back(step);
      missing += static_cast<std::size_t>(std::max(0L, std::lround(step) - 1));
    }
  }
  if (steps.size() < kEnough) return model;
  const double middle = median(areas);
  for (double& area : areas) area = std::abs(area - middle);
  model.area = std::exp(middle);
  model.area_spread = std::clamp(deviationFrom(areas), 0.25, 0.9);
  model.aside = std::clamp(deviationFrom(asides), 0.004, 0.4 * model.half);
  const double usual = median(steps);
  model.distance = before.distance * usual;
  learnSteps(rows, model);
  learnValleys(rows, pieces, before, model);
  const auto places = static_cast<double>(areas.size() + missing);
  model.missing = std::clamp(static_cast<double>(missing) / places, 0.01, 0.5);
  const double unused =
      static_cast<double>(all - used) / static_cast<double>(std::max<std::size_t>(1, all));
  model.clutter = std::clamp(unused, 0.01, 0.3);
  return model;
}

double modelError(const std::vector<Chain>& rows, const StandModel& model, double cell) {
  double doubt = 0.0;
  double plants = 0.0;
  for (const Chain& row : rows) {
    plants += row.expected;
    for (const PlantGroup& group : row.candidates) {
      doubt += group.probability * (1.0 - group.probability);
    }
  }
  if (!(plants > 0.0)) return 1.0;
  const double competing = kCompeting * doubt / plants;
  const double astray = kAstray * std::max(0.0, model.drift - kLeastDrift);
  const double coarse = kCoarse * cell / model.distance;
  return std::sqrt(kLeastError * kLeastError + competing * competing + astray * astray +
                   coarse * coarse);
}

}  // namespace agricolmap::crop
