#include "agricolmap/crop/plant_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace agricolmap::crop {

namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();
constexpr double kWidest = 1.0;          // from first to last top of a plant, in spacings
constexpr std::size_t kMostBetween = 6;  // pieces of clutter from plant to plant
constexpr double kClearest = 6.0;        // log odds that no valley exceeds
constexpr double kApart = 0.7;           // in spacings: farther says no more
constexpr double kDeepValley = 9.0;      // log odds of a valley down to the soil over none
constexpr double kFarValley = 10.8;      // of a spacing between the tops beside it
constexpr double kClutterShrink = 0.3;   // usual area of clutter, of a plant's
constexpr double kClutterSpread = 1.1;
constexpr double kFloor = 0.004;  // of the density of steps: what no rhythm explains
constexpr int kMostSteps = 7;

double logNormal(double x, double sigma) {
  const double u = x / sigma;
  return -0.5 * u * u - std::log(sigma * std::sqrt(2.0 * std::numbers::pi));
}

double logSum(double a, double b) {
  const double high = std::max(a, b);
  if (high == kNone) return kNone;
  return high + std::log(std::exp(a - high) + std::exp(b - high));
}

double logOfLogistic(double x) { return -std::log1p(std::exp(-x)); }

/// What a row's explanations are made of.
class RowTerms {
 public:
  RowTerms(const std::vector<Piece>& pieces, const StandModel& model)
      : pieces_(pieces), model_(model) {
    clutter_.push_back(0.0);
    aside_.push_back(0.0);
    for (const Piece& piece : pieces) {
      aside_.push_back(aside_.back() + logNormal(piece.aside, model.aside));
      const double area = std::max(piece.area, 1e-3 * model.area);
      clutter_.push_back(clutter_.back() + std::log(model.clutter) +
                         logNormal(std::log(area / (kClutterShrink * model.area)), kClutterSpread) -
                         std::log(2.0 * model.half));
    }
    parted_.push_back(0.0);
    joined_.push_back(0.0);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      const double clear = clearness(pieces[i], pieces[i + 1], model);
      parted_.push_back(parted_.back() + logOfLogistic(clear));
      joined_.push_back(joined_.back() + logOfLogistic(-clear));
    }
  }

  std::size_t size() const { return pieces_.size(); }

  PlantGroup group(std::size_t first, std::size_t last) const {
    PlantGroup group{first, last, 0.0, 0.0, 0.0, 0.0};
    double weight = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      const double area = std::max(pieces_[i].area, 1e-3 * model_.area);
      group.area += area;
      group.middle += area * pieces_[i].middle;
      group.aside += area * pieces_[i].aside;
      weight += area;
    }
    group.middle /= weight;
    group.aside /= weight;
    return group;
  }

  bool tooWide(std::size_t first, std::size_t last) const {
    return pieces_[last].top - pieces_[first].top > kWidest * model_.distance;
  }

  double plant(const PlantGroup& group) const {
    return std::log(1.0 - model_.clutter) +
           logNormal(std::log(group.area / model_.area), model_.area_spread) +
           aside_[group.last + 1] - aside_[group.first] + joined_[group.last] -
           joined_[group.first];
  }

  /// Pieces from `begin` to before `end` that are clutter, with the valleys about them: `before`
  /// is whether a plant stands before them, `after` behind.
  double between(std::size_t begin, std::size_t end, bool before, bool after) const {
    double sum = clutter_[end] - clutter_[begin];
    const std::size_t from = before ? begin - 1 : begin;
    const std::size_t to = after ? end : (end > 0 ? end - 1 : 0);
    if (to > from) sum += parted_[to] - parted_[from];
    return sum;
  }

  double distance() const { return model_.distance; }

 private:
  const std::vector<Piece>& pieces_;
  const StandModel& model_;
  std::vector<double> clutter_;  ///< summed up
  std::vector<double> parted_;   ///< of the valleys before each piece, summed up
  std::vector<double> joined_;
  std::vector<double> aside_;
};

/// How far a plant stands from its place in the rhythm, in bins.
constexpr int kPhases = 13;
constexpr int kMiddlePhase = 6;
constexpr double kPhaseWidth = 0.08;  // in spacings
using Phases = std::array<double, kPhases>;

/// Which steps the rhythm allows.
class Rhythm {
 public:
  explicit Rhythm(const StandModel& model) {
    double sum = 0.0;
    for (int d = 0; d < kPhases; ++d) {
      const double u = (d - kMiddlePhase) * kPhaseWidth / model.jitter;
      prior_[static_cast<std::size_t>(d)] = std::exp(-0.5 * u * u);
      sum += prior_[static_cast<std::size_t>(d)];
    }
    for (double& prior : prior_) prior /= sum;
    for (int i = 0; i < kTable; ++i) {
      const double step = kFirst + i * kResolution;
      double density = kFloor;
      double share = 1.0 - model.missing;
      for (int n = 1; n <= kMostSteps; ++n) {
        density += share * std::exp(logNormal(step - n, model.drift * std::sqrt(n)));
        share *= model.missing;
      }
      table_[static_cast<std::size_t>(i)] = density;
    }
  }
  const Phases& prior() const { return prior_; }
  /// Density of a step by this many spacings from place to place.
  double at(double step) const {
    const auto i = static_cast<int>(std::lround((step - kFirst) / kResolution));
    return i < 0 || i >= kTable ? kFloor : table_[static_cast<std::size_t>(i)];
  }

 private:
  static constexpr double kFirst = -1.0;
  static constexpr double kResolution = 0.02;
  static constexpr int kTable = 480;
  Phases prior_{};
  std::array<double, kTable> table_{};
};

/// Of the explanations that end, or go on, with a plant at a phase.
struct Ends {
  double scale = kNone;  ///< logarithm that `ahead` is relative to
  Phases ahead{};        ///< their sum up to and with it
  Phases count{};        ///< mean number of plants up to it
  Phases square{};       ///< and of its square
  double back_scale = kNone;
  Phases back{};  ///< their sum behind it
  Phases best{};  ///< logarithm of the likeliest
  std::array<std::ptrdiff_t, kPhases> from{};

  double logAhead() const {
    double sum = 0.0;
    for (const double value : ahead) sum += value;
    return sum > 0.0 ? scale + std::log(sum) : kNone;
  }
};

class ChainSolver {
 public:
  ChainSolver(const RowTerms& terms, const StandModel& model) : terms_(terms), rhythm_(model) {
    const std::size_t size = terms.size();
    finishes_.resize(size + 1);
    for (std::size_t last = 0; last < size; ++last) {
      for (std::size_t first = last + 1; first-- > 0;) {
        if (terms.tooWide(first, last)) break;
        finishes_[last].push_back(groups_.size());
        groups_.push_back(terms.group(first, last));
        own_.push_back(terms.plant(groups_.back()));
      }
    }
    ends_.resize(groups_.size());
  }

  Chain solve() {
    for (std::size_t g = 0; g < groups_.size(); ++g) forward(g);
    for (std::size_t g = groups_.size(); g-- > 0;) backward(g);
    return result();
  }

 private:
  double tail(std::size_t g) const {
    return terms_.between(groups_[g].last + 1, terms_.size(), true, false);
  }

  /// The groups that may be the plant before this one, and what is between them.
  template <typename Visit>
  void eachBefore(std::size_t g, const Visit& visit) const {
    const std::size_t first = groups_[g].first;
    for (std::size_t between = 0; between <= kMostBetween && between < first; ++between) {
      const std::size_t last = first - 1 - between;
      const double term = terms_.between(last + 1, first, true, true);
      for (const std::size_t before : finishes_[last]) visit(before, term);
    }
  }

  /// Density of the step from one plant to the next, by the difference of their phases.
  std::array<double, 2 * kPhases - 1> steps(std::size_t a, std::size_t b) const {
    std::array<double, 2 * kPhases - 1> densities{};
    const double step = (groups_[b].middle - groups_[a].middle) / terms_.distance();
    for (int k = 0; k < 2 * kPhases - 1; ++k) {
      densities[static_cast<std::size_t>(k)] = rhythm_.at(step - (k - kPhases + 1) * kPhaseWidth);
    }
    return densities;
  }

  /// Groups are in order of their last piece, so all that may stand before one are done.
  void forward(std::size_t g) {
    Ends& end = ends_[g];
    const double start = terms_.between(0, groups_[g].first, false, true);
    double scale = start;
    eachBefore(g, [&](std::size_t before, double term) {
      scale = std::max(scale, ends_[before].scale + term);
    });
    end.scale = scale + own_[g];
    end.ahead.fill(std::exp(start - scale));
    end.best.fill(start);
    end.from.fill(-1);
    eachBefore(g, [&](std::size_t before, double term) {
      const Ends& other = ends_[before];
      const double factor = std::exp(other.scale + term - scale);
      const auto densities = steps(before, g);
      for (std::size_t d = 0; d < kPhases; ++d) {
        for (std::size_t c = 0; c < kPhases; ++c) {
          const double density = densities[d + kPhases - 1 - c];
          const double add = factor * other.ahead[c] * density;
          end.ahead[d] += add;
          end.count[d] += add * other.count[c];
          end.square[d] += add * other.square[c];
          if (density < 2.0 * kFloor && factor < 1e-6) continue;
          const double best = other.best[c] + term + std::log(density);
          if (best > end.best[d]) {
            end.best[d] = best;
            end.from[d] = static_cast<std::ptrdiff_t>(before * kPhases + c);
          }
        }
      }
    });
    for (std::size_t d = 0; d < kPhases; ++d) {
      end.count[d] /= end.ahead[d];
      end.square[d] = end.square[d] / end.ahead[d] + 2.0 * end.count[d] + 1.0;
      end.count[d] += 1.0;
      end.ahead[d] *= rhythm_.prior()[d];
      end.best[d] += own_[g] + std::log(rhythm_.prior()[d]);
    }
    rescale(end.ahead, end.scale);
    // What is summed up next is added to the backward sums of those before.
    end.back.fill(0.0);
  }

  /// From its own to those that may stand before it.
  void backward(std::size_t g) {
    Ends& end = ends_[g];
    const double stop = tail(g);
    addBack(end, stop, 1.0, {});
    rescale(end.back, end.back_scale);
    eachBefore(g, [&](std::size_t before, double term) {
      const auto densities = steps(before, g);
      Phases sum{};
      for (std::size_t d = 0; d < kPhases; ++d) {
        const double value = end.back[d] * rhythm_.prior()[d];
        for (std::size_t c = 0; c < kPhases; ++c) {
          sum[c] += value * densities[d + kPhases - 1 - c];
        }
      }
      addBack(ends_[before], end.back_scale + own_[g] + term, 0.0, sum);
    });
  }

  /// Every step multiplies by a density: of a thousand plants no double holds the product.
  static void rescale(Phases& values, double& scale) {
    const double most = *std::max_element(values.begin(), values.end());
    if (!(most > 0.0)) return;
    for (double& value : values) value /= most;
    scale += std::log(most);
  }

  static void addBack(Ends& end, double scale, double all, const Phases& values) {
    if (scale > end.back_scale) {
      const double shrink = std::exp(end.back_scale - scale);
      for (double& value : end.back) value *= shrink;
      end.back_scale = scale;
    }
    const double factor = std::exp(scale - end.back_scale);
    for (std::size_t d = 0; d < kPhases; ++d) end.back[d] += factor * (all + values[d]);
  }

  double logProbability(std::size_t g, double total) const {
    const Ends& end = ends_[g];
    double sum = 0.0;
    for (std::size_t d = 0; d < kPhases; ++d) sum += end.ahead[d] * end.back[d];
    return sum > 0.0 ? end.scale + end.back_scale + std::log(sum) - total : kNone;
  }

  Chain result() const {
    Chain chain;
    const double none = terms_.between(0, terms_.size(), false, false);
    double total = none;
    double best = none;
    std::ptrdiff_t at = -1;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      total = logSum(total, ends_[g].logAhead() + tail(g));
      for (std::size_t d = 0; d < kPhases; ++d) {
        if (ends_[g].best[d] + tail(g) <= best) continue;
        best = ends_[g].best[d] + tail(g);
        at = static_cast<std::ptrdiff_t>(g * kPhases + d);
      }
    }
    double square = 0.0;
    chain.between.assign(terms_.size(), 1.0);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Ends& end = ends_[g];
      const double factor = std::exp(end.scale + tail(g) - total);
      for (std::size_t d = 0; d < kPhases; ++d) {
        chain.expected += factor * end.ahead[d] * end.count[d];
        square += factor * end.ahead[d] * end.square[d];
      }
      PlantGroup group = groups_[g];
      group.probability = std::min(1.0, std::exp(logProbability(g, total)));
      for (std::size_t k = group.first; k < group.last; ++k) chain.between[k] -= group.probability;
      if (group.probability > 0.002) chain.candidates.push_back(group);
    }
    chain.variance = std::max(0.0, square - chain.expected * chain.expected);
    while (at >= 0) {
      const auto g = static_cast<std::size_t>(at) / kPhases;
      const auto d = static_cast<std::size_t>(at) % kPhases;
      chain.plants.push_back(groups_[g]);
      chain.plants.back().probability = std::min(1.0, std::exp(logProbability(g, total)));
      at = ends_[g].from[d];
    }
    std::reverse(chain.plants.begin(), chain.plants.end());
    return chain;
  }

  const RowTerms& terms_;
  Rhythm rhythm_;
  std::vector<PlantGroup> groups_;
  std::vector<double> own_;
  std::vector<std::vector<std::size_t>> finishes_;  ///< groups by their last piece
  std::vector<Ends> ends_;
};

}  // namespace

double clearness(const Piece& a, const Piece& b, const StandModel& model) {
  const double apart = std::min((b.top - a.top) / model.distance, kApart);
  const double odds =
      model.valley + kDeepValley * std::clamp(a.parted, 0.0, 1.0) + kFarValley * apart;
  return std::clamp(odds, -kClearest, kClearest);
}

Chain chainOf(const std::vector<Piece>& pieces, const StandModel& model) {
  if (pieces.empty()) return {};
  const RowTerms terms(pieces, model);
  return ChainSolver(terms, model).solve();
}

}  // namespace agricolmap::crop
