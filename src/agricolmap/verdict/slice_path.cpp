#include "agricolmap/verdict/slice_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace agricolmap::verdict {
namespace {

/// Share of the slices whose plants both views show alike; the others' scores are chance wherever
/// they lie.
constexpr double kInformative = 0.7;
/// How likely something happens between two slices: that the strip slips to anywhere in reach, that
/// it slips back to where the pose has it, that drift takes it to a neighbouring cell.
constexpr double kSlip = 0.01;
constexpr double kBack = 0.05;
constexpr double kDrift = 0.1;
constexpr double kMostExponent = 60.0;
/// A window whose peak is lower tells nothing of how well the pair can fit.
constexpr double kLeastPeak = 4.5;
constexpr int kRounds = 3;

/// The shifts in reach, numbered.
class Lattice {
 public:
  Lattice(const Slices& slices, double reach)
      : half_(std::min(slices.reach - 1, static_cast<int>(std::floor(reach / slices.cell)))),
        number_(2 * half_ + 1, 2 * half_ + 1, -1) {
    for (int r = -half_; r <= half_; ++r) {
      for (int c = -half_; c <= half_; ++c) {
        if (std::hypot(r, c) * slices.cell > reach) continue;
        number_(r + half_, c + half_) = static_cast<int>(shifts_.size());
        shifts_.emplace_back(c, r);
      }
    }
  }
  std::size_t size() const { return shifts_.size(); }
  const Eigen::Vector2i& operator[](std::size_t i) const { return shifts_[i]; }
  /// Number of a shift; negative when it is out of reach.
  int at(const Eigen::Vector2i& shift) const {
    const int r = shift.y() + half_, c = shift.x() + half_;
    return number_.contains(r, c) ? number_(r, c) : -1;
  }

 private:
  int half_;
  Raster<int> number_;
  std::vector<Eigen::Vector2i> shifts_;
};

double scoreAt(const Slices& slices, std::size_t i, const Eigen::Vector2i& shift) {
  return static_cast<double>(
      slices.slices[i].scores(slices.reach + shift.y(), slices.reach + shift.x()));
}

/// Score that the pair gives in place, per variance of what chance gives: the same along the strip,
/// as far as the views show the same everywhere.
double amplitudeAlong(const Slices& slices, const std::vector<Eigen::Vector2i>& path) {
  double score = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!slices.slices[i].tells()) continue;
    score += scoreAt(slices, i, path[i]);
    variance += std::pow(slices.slices[i].deviation, 2);
  }
  return variance > 0.0 ? score / variance : 0.0;
}

/// That of the strip's whole, half or third that fits best anywhere in reach.
double bestAmplitude(const Slices& slices, const Lattice& lattice) {
  const std::size_t count = slices.slices.size();
  double best = amplitudeAlong(slices, std::vector<Eigen::Vector2i>(count, {0, 0}));
  for (std::size_t parts = 1; parts <= 3; ++parts) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t first = part * count / parts, last = (part + 1) * count / parts;
      double variance = 0.0;
      std::vector<double> sums(lattice.size(), 0.0);
      for (std::size_t i = first; i < last; ++i) {
        if (!slices.slices[i].tells()) continue;
        variance += std::pow(slices.slices[i].deviation, 2);
        for (std::size_t s = 0; s < sums.size(); ++s) sums[s] += scoreAt(slices, i, lattice[s]);
      }
      if (variance <= 0.0) continue;
      const double peak = *std::max_element(sums.begin(), sums.end());
      if (peak >= kLeastPeak * std::sqrt(variance)) best = std::max(best, peak / variance);
    }
  }
  return best;
}

/// Log-likelihood of each slice's scores at each shift, against chance. Where a slice lies its
/// score is normal about amplitude · variance; the share of slices that show nothing alike bounds
/// what any one of them can say against its place.
std::vector<std::vector<double>> likelihoods(const Slices& slices, const Lattice& lattice,
                                             double amplitude) {
  std::vector<std::vector<double>> result(slices.slices.size(),
                                          std::vector<double>(lattice.size(), 0.0));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Slice& slice = slices.slices[i];
    if (!slice.tells()) continue;
    const double expected = amplitude * slice.deviation;
    for (std::size_t s = 0; s < lattice.size(); ++s) {
      const double exponent =
          amplitude * scoreAt(slices, i, lattice[s]) - 0.5 * expected * expected;
      result[i][s] =
          std::log(1.0 - kInformative + kInformative * std::exp(std::min(exponent, kMostExponent)));
    }
  }
  return result;
}

struct Moves {
  double slip;  ///< logarithms of the probabilities
  double back;
  double drift;
};

/// What leads to each shift of the next slice from the best of `before`, and from which.
void advance(const std::vector<double>& before, const Lattice& lattice, const Moves& moves,
             std::vector<double>& next, std::vector<int>& from) {
  const auto highest = std::max_element(before.begin(), before.end());
  const auto jump_from = static_cast<int>(highest - before.begin());
  for (std::size_t s = 0; s < lattice.size(); ++s) {
    next[s] = before[s];
    from[s] = static_cast<int>(s);
    const double jump = *highest + (lattice[s].isZero() ? moves.back : moves.slip);
    if (jump > next[s]) next[s] = jump, from[s] = jump_from;
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) {
        const int other = lattice.at(lattice[s] + Eigen::Vector2i(dc, dr));
        if (other < 0 || (dr == 0 && dc == 0)) continue;
        const double drift = before[static_cast<std::size_t>(other)] + moves.drift;
        if (drift > next[s]) next[s] = drift, from[s] = other;
      }
    }
  }
}

/// The likeliest path, as numbers of the lattice, and its log-odds against staying at no shift.
std::pair<std::vector<std::size_t>, double> viterbi(
    const std::vector<std::vector<double>>& likelihood, const Lattice& lattice) {
  const auto states = static_cast<double>(lattice.size());
  const Moves moves{std::log(kSlip / states), std::log(kBack), std::log(kDrift / 8.0)};
  const auto none = static_cast<std::size_t>(lattice.at({0, 0}));
  // Before the first slice the pose holds.
  std::vector<double> value(lattice.size(), -std::numeric_limits<double>::infinity());
  value[none] = 0.0;
  std::vector<double> next(lattice.size());
  std::vector<std::vector<int>> from(likelihood.size(), std::vector<int>(lattice.size()));
  double stay = 0.0;
  for (std::size_t i = 0; i < likelihood.size(); ++i) {
    advance(value, lattice, moves, next, from[i]);
    for (std::size_t s = 0; s < lattice.size(); ++s) value[s] = next[s] + likelihood[i][s];
    stay += likelihood[i][none];
  }
  auto state =
      static_cast<std::size_t>(std::max_element(value.begin(), value.end()) - value.begin());
  const double odds = value[state] - stay;
  std::vector<std::size_t> path(likelihood.size());
  for (std::size_t i = likelihood.size(); i-- > 0;) {
    path[i] = state;
    state = static_cast<std::size_t>(from[i][state]);
  }
  return {path, odds};
}

}  // namespace

SlicePath likeliestPath(const Slices& slices, double reach) {
  SlicePath path;
  const Lattice lattice(slices, reach);
  if (lattice.size() < 2) return path;
  double amplitude = bestAmplitude(slices, lattice);
  if (amplitude <= 0.0) return path;
  const auto none = static_cast<std::size_t>(lattice.at({0, 0}));
  for (int round = 0; round < kRounds; ++round) {
    const auto likelihood = likelihoods(slices, lattice, amplitude);
    const auto [states, odds] = viterbi(likelihood, lattice);
    path = {};
    path.log_odds = odds;
    for (std::size_t i = 0; i < states.size(); ++i) {
      path.shifts.push_back(lattice[states[i]]);
      path.gain.push_back(likelihood[i][states[i]] - likelihood[i][none]);
    }
    amplitude = amplitudeAlong(slices, path.shifts);
    if (amplitude <= 0.0) return {};
  }
  return path;
}

}  // namespace agricolmap::verdict
