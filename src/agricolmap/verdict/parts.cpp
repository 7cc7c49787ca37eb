#include "agricolmap/verdict/parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "agricolmap/core/parabola.hpp"
#include "agricolmap/verdict/slice_path.hpp"
#include "agricolmap/verdict/slip.hpp"

namespace agricolmap::verdict {
namespace {

constexpr double kReach = 1.0;  ///< how far a part is looked for [m]
constexpr double kFar = 1.6;    ///< how far chance is looked at [m]
/// Nearer than this to a part's place, or to that of the whole, are their own peaks [m].
constexpr double kOwnPeak = 0.25;
/// A part is displaced from this on: less is the drift that every strip has [m].
constexpr double kLeastOffset = 0.065;
/// One slice alone may be a place where plants changed: on real flights a week apart some do.
constexpr std::size_t kLeastSlices = 2;
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
    part.offset = slices_.cell * (mean_ + beyond());
    part.significance = peak / deviation_;
    part.uniqueness = peak / std::max(deviation_, highestElsewhere());
    return part;
  }
  /// Of a slice of it that the path moves by `shift` [m].
  Eigen::Vector2d offset(const Eigen::Vector2i& shift) const {
    return slices_.cell * (shift.cast<double>() + beyond());
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
  /// How far the peak lies beside the path [cells].
  Eigen::Vector2d beyond() const {
    const double peak = followed(0, 0);
    return {parabolaVertex(followed(0, -1), peak, followed(0, 1)),
            parabolaVertex(followed(-1, 0), peak, followed(1, 0))};
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

/// Where the path and the peaks beside it put the slices that tell; each with its neighbours',
/// which alone are too small for centimetres.
std::vector<SliceOffset> offsetsOf(const Slices& slices, const std::vector<Eigen::Vector2i>& path) {
  std::vector<SliceOffset> offsets;
  const double middle = 0.5 * slices.slices.back().end;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!slices.slices[i].tells()) continue;
    const auto alike = [&](std::size_t j) {
      return (path[j] - path[i]).cwiseAbs().maxCoeff() <= 1;
    };
    Run run{i, i + 1};
    if (i > 0 && alike(i - 1)) --run.first;
    if (i + 1 < path.size() && alike(i + 1)) ++run.last;
    const Eigen::Vector2d offset = Part(slices, path, run).offset(path[i]);
    offsets.push_back({0.5 * (slices.slices[i].begin + slices.slices[i].end) - middle, offset});
  }
  return offsets;
}

double rmsOf(const std::vector<SliceOffset>& offsets) {
  double sum2 = 0.0;
  for (const SliceOffset& slice : offsets) sum2 += slice.offset.squaredNorm();
  return std::sqrt(sum2 / static_cast<double>(offsets.size()));
}

std::optional<Eigen::Affine2d> largerPose(const std::vector<SliceOffset>& offsets,
                                          const map::StripFrame& strip,
                                          const Eigen::Affine2d& pose) {
  const std::optional<Compromise> compromise = largerPart(offsets);
  if (!compromise) return std::nullopt;
  // In the moving frame `along` is the first strip coordinate.
  const Eigen::RowVector2d along = strip.axes.col(0).transpose();
  Eigen::Affine2d larger = pose;
  larger.linear() += compromise->slope * along;
  larger.translation() += compromise->shift - compromise->slope * (along * strip.centre);
  return larger;
}

}  // namespace

PartsReport findDisplacedParts(const correlation::StripScore& score, const Eigen::Affine2d& pose) {
  PartsReport report;
  report.length = 2.0 * score.strip().half_extent.x();
  report.along = (pose.linear() * score.strip().axes.col(0)).normalized();
  const Slices slices = scoreSlices(score, pose, kFar);
  const SlicePath path = likeliestPath(slices, kReach);
  for (const Run& run : runsOf(path.shifts)) {
    if (path.shifts[run.first].isZero() || run.last - run.first < kLeastSlices) continue;
    const Part part(slices, path.shifts, run);
    if (part.empty()) continue;
    double gain = 0.0;
    for (std::size_t i = run.first; i < run.last; ++i) gain += path.gain[i];
    const DisplacedPart found = part.measured();
    if (stands(found, gain)) report.displaced.push_back(found);
  }
  if (report.displaced.empty()) return report;
  report.probability = 1.0 / (1.0 + std::exp(path.log_odds));
  report.slices = offsetsOf(slices, path.shifts);
  report.rms = rmsOf(report.slices);
  if (report.apart()) report.larger = largerPose(report.slices, score.strip(), pose);
  return report;
}

}  // namespace agricolmap::verdict
