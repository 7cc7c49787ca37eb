#include "agricolmap/verdict/parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/verdict/slice_path.hpp"

namespace agricolmap::verdict {
namespace {

constexpr double kReach = 1.0;  ///< how far a part is looked for [m]
constexpr double kFar = 1.6;    ///< how far chance is looked at [m]
/// Nearer than this to a part's place, or to that of the whole, are their own peaks [m].
constexpr double kOwnPeak = 0.25;
/// A part is displaced from this on: less is the drift that every strip has [m].
constexpr double kLeastOffset = 0.065;
/// A peak below this, or not so much higher than the highest of chance, is chance itself.
constexpr double kLeastSignificance = 4.5;
constexpr double kLeastUniqueness = 1.25;
/// Times that a displaced part must be likelier there than where the whole puts it: its logarithm.
constexpr double kLeastGain = 8.0;

/// Slices next to one another that the path moves alike, to a cell from each to the next.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;  ///< the one behind
};

std::vector<Run> runsOf(const std::vector<Eigen::Vector2i>& path) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool more = i > 0 && path[i].isZero() == path[i - 1].isZero() &&
                      (path[i] - path[i - 1]).cwiseAbs().maxCoeff() <= 1;
    if (more) {
      runs.back().last = i + 1;
    } else {
      runs.push_back({i, i + 1});
    }
  }
  return runs;
}

/// A run of slices, its scores and what they are measured by.
class Part {
 public:
  Part(const Slices& slices, const std::vector<Eigen::Vector2i>& path, Run run)
      : slices_(slices), path_(path), run_(run) {
    // Slices that tell nothing at its ends are not known to belong to it.
    while (run_.first < run_.last && !slices.slices[run_.first].tells()) ++run_.first;
    while (run_.first < run_.last && !slices.slices[run_.last - 1].tells()) --run_.last;
    double variance = 0.0;
    double count = 0.0;
    forEach([&](std::size_t i) {
      variance += std::pow(slices_.slices[i].deviation, 2);
      mean_ += path_[i].cast<double>();
      count += 1.0;
    });
    if (count == 0.0) return;
    mean_ /= count;
    deviation_ = std::sqrt(variance);
  }
  bool empty() const { return deviation_ <= 0.0; }

  DisplacedPart measured() const {
    DisplacedPart part;
    part.begin = slices_.slices[run_.first].begin;
    part.end = slices_.slices[run_.last - 1].end;
    const double peak = followed(0, 0);
    const Eigen::Vector2d beyond(parabolaVertex(followed(0, -1), peak, followed(0, 1)),
                                 parabolaVertex(followed(-1, 0), peak, followed(1, 0)));
    part.offset = slices_.cell * (mean_ + beyond);
    part.significance = peak / deviation_;
    part.uniqueness = peak / std::max(deviation_, highestElsewhere());
    return part;
  }

 private:
  template <typename Body>
  void forEach(const Body& body) const {
    for (std::size_t i = run_.first; i < run_.last; ++i) {
      if (slices_.slices[i].tells()) body(i);
    }
  }
  /// Score of the run where the path puts its slices and `row`, `col` cells beyond.
  double followed(int row, int col) const {
    double sum = 0.0;
    forEach([&](std::size_t i) {
      sum += static_cast<double>(slices_.slices[i].scores(slices_.reach + path_[i].y() + row,
                                                          slices_.reach + path_[i].x() + col));
    });
    return sum;
  }
  double highestElsewhere() const {
    double highest = 0.0;
    for (int r = -slices_.reach; r <= slices_.reach; ++r) {
      for (int c = -slices_.reach; c <= slices_.reach; ++c) {
        const Eigen::Vector2d shift(c, r);
        if (std::min(shift.norm(), (shift - mean_).norm()) * slices_.cell <= kOwnPeak) continue;
        double sum = 0.0;
        forEach([&](std::size_t i) {
          sum +=
              static_cast<double>(slices_.slices[i].scores(slices_.reach + r, slices_.reach + c));
        });
        highest = std::max(highest, sum);
      }
    }
    return highest;
  }

  const Slices& slices_;
  const std::vector<Eigen::Vector2i>& path_;
  Run run_;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();  ///< of its slices' shifts [cells], x and y
  double deviation_ = 0.0;                          ///< of its score by chance
};

bool stands(const DisplacedPart& part, double gain) {
  return part.offset.norm() >= kLeastOffset && part.significance >= kLeastSignificance &&
         part.uniqueness >= kLeastUniqueness && gain >= kLeastGain;
}

}  // namespace

PartsReport findDisplacedParts(const Slices& slices) {
  PartsReport report;
  if (slices.slices.empty()) return report;
  const SlicePath path = likeliestPath(slices, kReach);
  if (path.shifts.empty()) return report;
  const double length = slices.slices.back().end;
  double sum2 = 0.0;
  for (const Run& run : runsOf(path.shifts)) {
    if (path.shifts[run.first].isZero()) continue;
    const Part part(slices, path.shifts, run);
    if (part.empty()) continue;
    double gain = 0.0;
    for (std::size_t i = run.first; i < run.last; ++i) gain += path.gain[i];
    const DisplacedPart found = part.measured();
    if (!stands(found, gain)) continue;
    sum2 += found.offset.squaredNorm() * (found.end - found.begin) / length;
    report.displaced.push_back(found);
  }
  report.rms = std::sqrt(sum2);
  if (!report.displaced.empty()) report.probability = 1.0 / (1.0 + std::exp(path.log_odds));
  return report;
}

PartsReport findDisplacedParts(const correlation::StripScore& score, const Eigen::Affine2d& pose) {
  PartsReport report = findDisplacedParts(scoreSlices(score, pose, kFar));
  report.length = 2.0 * score.strip().half_extent.x();
  report.along = (pose.linear() * score.strip().axes.col(0)).normalized();
  return report;
}

}  // namespace agricolmap::verdict
