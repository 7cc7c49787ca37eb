#include "agricolmap/paper/vote/coherent_vote.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/keep_distinct.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, VoteOptions& options) {
  table.choice("kind", options.kind, {"pose", "displacement"},
               "what matches vote for: heading, scales and displacement, or the paper's "
               "displacement alone");
  // The work grows with the fifth power of a finer step: hypotheses in three dimensions, bins in
  // two.
  table.number("step", options.step, 0.5, 100.0, "cells", "t_f in the paper: step of the vote")
      .basic();
  table.number("coarse", options.coarse, 4.0, 100.0, "t_f",
               "step of the search over heading and scales; kind pose");
  table.number("tolerance", options.tolerance, 0.5, 100.0, "t_f",
               "largest distance of a coherent match from its placement; kind pose");
  table.integer("placements", options.placements, 1, 100, "", "distinct placements at most");
  table.integer("least", options.least, 3, 1000000, "", "votes that a placement needs");
}

namespace {

constexpr std::size_t kCandidates = 12;  ///< bins drawn in to placements
constexpr int kDrawSteps = 12;
constexpr double kWidestBins = 2048.0;  ///< per axis, a guard against absurd searches

/// Matches about a pivot: single precision is plenty for metres. By coordinates, so that loops
/// vectorise.
struct Pairs {
  Eigen::Vector2d pivot;
  std::vector<float> qx, qy;               ///< moving − pivot
  std::vector<float> px, py;               ///< fixed − pivot
  Eigen::Vector2d half_extent;             ///< of q along the axes [m]
  std::array<Eigen::Vector2d, 4> corners;  ///< of the moving points' box along the axes [m]
};

Pairs pairsOf(std::span<const Match> matches, const Eigen::Matrix2d& axes) {
  Pairs pairs;
  Eigen::AlignedBox2d box;
  for (const Match& match : matches) box.extend(axes.transpose() * match.moving);
  pairs.pivot = axes * box.center();
  pairs.half_extent = 0.5 * box.sizes();
  pairs.corners = cornersOf(box);
  for (Eigen::Vector2d& corner : pairs.corners) corner = axes * corner;
  for (const Match& match : matches) {
    const Eigen::Vector2f q = (match.moving - pairs.pivot).cast<float>();
    const Eigen::Vector2f p = (match.fixed - pairs.pivot).cast<float>();
    pairs.qx.push_back(q.x());
    pairs.qy.push_back(q.y());
    pairs.px.push_back(p.x());
    pairs.py.push_back(p.y());
  }
  return pairs;
}

/// −limit…limit in equal steps of at most `step`, odd in number.
std::vector<double> lattice(double limit, double step) {
  const int half = static_cast<int>(std::ceil(limit / step));
  std::vector<double> values;
  for (int k = -half; k <= half; ++k) values.push_back(half > 0 ? limit * k / half : 0.0);
  return values;
}

std::vector<YawScales> hypotheses(const PriorUncertainty& u, const Eigen::Vector2d& half_extent,
                                  double step) {
  const auto stepFor = [&](double arm) { return step / std::max(arm, step); };
  std::vector<YawScales> result;
  for (const double yaw : lattice(radians(u.heading_deg), stepFor(half_extent.norm()))) {
    for (const double x : lattice(logScaleLimit(u), stepFor(half_extent.x()))) {
      for (const double y : lattice(logScaleLimit(u), stepFor(half_extent.y()))) {
        result.push_back(YawScales::fromVector({yaw, x, y}));
      }
    }
  }
  return result;
}

/// The fullest 2 × 2 bins of a hypothesis and their middle.
struct Peak {
  int votes = 0;
  std::size_t hypothesis = 0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< of the pivot [m]
};

/// Votes of all matches for the pivot's displacement under one linear map.
class ShiftVote {
 public:
  ShiftVote(const Pairs& pairs, const Eigen::AlignedBox2d& window, double bin)
      : pairs_(pairs), corner_(window.min().cast<float>()), bin_(static_cast<float>(bin)) {
    const Eigen::Array2d count = (window.sizes().array() / bin).min(kWidestBins);
    cols_ = static_cast<int>(count.x()) + 2;
    rows_ = static_cast<int>(count.y()) + 2;
  }

  /// Memory of a vote, used again by the next.
  struct Scratch {
    std::vector<std::uint16_t> bins;
    std::vector<std::uint32_t> bin_of;  ///< per match
  };

  Peak vote(const Eigen::Matrix2d& linear, Scratch& scratch) const {
    count(linear, scratch);
    // Sums of four bins fit into 16 bits where there are no more matches than that.
    return pairs_.qx.size() <= 0xFFFF ? fullest<std::uint16_t>(scratch.bins)
                                      : fullest<std::uint32_t>(scratch.bins);
  }

 private:
  void count(const Eigen::Matrix2d& linear, Scratch& scratch) const {
    // Matches outside the window vote for one more bin that is never looked at: no branch.
    const std::uint32_t outside = static_cast<std::uint32_t>(rows_) * cols_;
    scratch.bins.assign(outside + std::size_t{1}, 0);
    scratch.bin_of.resize(pairs_.qx.size());
    const Eigen::Matrix2f m = linear.cast<float>();
    const float scale = 1.0F / bin_;
    const float* qx = pairs_.qx.data();
    const float* qy = pairs_.qy.data();
    const float* px = pairs_.px.data();
    const float* py = pairs_.py.data();
    std::uint32_t* bin_of = scratch.bin_of.data();
    for (std::size_t i = 0; i < pairs_.qx.size(); ++i) {
      const float x = (px[i] - (m(0, 1) * qy[i] + m(0, 0) * qx[i]) - corner_.x()) * scale;
      const float y = (py[i] - (m(1, 1) * qy[i] + m(1, 0) * qx[i]) - corner_.y()) * scale;
      const int col = static_cast<int>(std::floor(x));
      const int row = static_cast<int>(std::floor(y));
      const bool inside = (col >= 0) & (row >= 0) & (col < cols_) & (row < rows_);
      bin_of[i] = inside ? static_cast<std::uint32_t>(row * cols_ + col) : outside;
    }
    for (const std::uint32_t i : scratch.bin_of) {
      std::uint16_t& bin = scratch.bins[i];
      bin = static_cast<std::uint16_t>(bin + (bin < 0xFFFF ? 1 : 0));
    }
  }

  /// The first of the fullest 2 × 2 bins: row by row the largest number, then its column.
  template <typename Sum>
  Peak fullest(const std::vector<std::uint16_t>& bins) const {
    const auto votesAt = [&](const std::uint16_t* here, int col) {
      const std::uint16_t* above = here + cols_;
      return static_cast<Sum>(Sum{here[col]} + here[col + 1] + above[col] + above[col + 1]);
    };
    Sum most = 0;
    int best_row = -1;
    for (int row = 0; row + 1 < rows_; ++row) {
      const std::uint16_t* here = bins.data() + static_cast<std::size_t>(row) * cols_;
      Sum most_here = 0;
      for (int col = 0; col + 1 < cols_; ++col) most_here = std::max(most_here, votesAt(here, col));
      if (most_here <= most) continue;
      most = most_here;
      best_row = row;
    }
    Peak best;
    if (best_row < 0) return best;
    const std::uint16_t* here = bins.data() + static_cast<std::size_t>(best_row) * cols_;
    int col = 0;
    while (votesAt(here, col) != most) ++col;
    best.votes = static_cast<int>(most);
    best.shift = (corner_ + bin_ * Eigen::Vector2f(static_cast<float>(col + 1),
                                                   static_cast<float>(best_row + 1)))
                     .cast<double>();
    return best;
  }

  const Pairs& pairs_;
  Eigen::Vector2f corner_;
  float bin_;
  int rows_ = 0;
  int cols_ = 0;
};

std::vector<std::uint32_t> within(std::span<const Match> matches, const Eigen::Affine2d& pose,
                                  double radius) {
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if ((pose * matches[i].moving - matches[i].fixed).squaredNorm() <= radius * radius) {
      result.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return result;
}

/// Alternates selection within a shrinking radius and weighted fits (Tukey's biweight).
VotedPlacement drawIn(std::span<const Match> matches, const Eigen::Affine2d& start,
                      const Eigen::Matrix2d& axes, double wide, double tolerance) {
  VotedPlacement placement;
  Eigen::Affine2d pose = start;
  std::vector<Match> chosen;
  std::vector<double> weights;
  for (int step = 0; step < kDrawSteps; ++step) {
    const double radius = std::max(tolerance, wide * std::pow(0.7, step));
    chosen.clear();
    weights.clear();
    for (const std::uint32_t i : within(matches, pose, radius)) {
      chosen.push_back(matches[i]);
      weights.push_back(tukeyWeight((pose * matches[i].moving - matches[i].fixed).norm() / radius));
    }
    const auto fit = fitScaledRotation(chosen, weights, axes);
    if (!fit) return {};
    placement.pose = *fit;
    pose = fit->fixed_from_moving;
  }
  placement.inliers = within(matches, pose, tolerance);
  return placement;
}

/// True inside what the initial guess allows, with a little play for the fit.
bool allowed(const ScaledRotation& pose, const PriorUncertainty& u) {
  return std::abs(pose.yaw) <= radians(u.heading_deg) + 0.05 &&
         pose.scale.array().log().abs().maxCoeff() <= logScaleLimit(u) + 0.05;
}

/// The best-supported placement of some matches; no inliers when nothing is supported.
VotedPlacement bestPlacement(std::span<const Match> matches, const SearchSpace& space,
                             const Eigen::Matrix2d& axes, double unit, const VoteOptions& options) {
  const double bin = options.coarse * unit;
  const Pairs pairs = pairsOf(matches, axes);
  const std::vector<YawScales> all = hypotheses(space.uncertainty, pairs.half_extent, bin);
  // The pivot moves by the translation plus what heading and scales do to its arm from the centre.
  const double arm = (pairs.pivot - space.centre).norm();
  const double reach = space.uncertainty.translation +
                       arm * (std::expm1(logScaleLimit(space.uncertainty)) +
                              std::min(2.0, radians(space.uncertainty.heading_deg))) +
                       bin;
  const Eigen::AlignedBox2d window(Eigen::Vector2d::Constant(-reach),
                                   Eigen::Vector2d::Constant(reach));
  const ShiftVote vote(pairs, window, bin);
  std::vector<Peak> peaks(all.size());
  parallelFor(
      all.size(),
      [&](std::size_t i) {
        thread_local ShiftVote::Scratch scratch;
        peaks[i] = vote.vote(all[i].linear(axes), scratch);
        peaks[i].hypothesis = i;
      },
      8);
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) {
    return a.votes != b.votes ? a.votes > b.votes : a.hypothesis < b.hypothesis;
  });
  std::vector<Eigen::Affine2d> supported;
  for (const Peak& peak : peaks) {
    if (peak.votes < options.least) break;
    Eigen::Affine2d pose;
    pose.linear() = all[peak.hypothesis].linear(axes);
    pose.translation() = pairs.pivot + peak.shift - pose.linear() * pairs.pivot;
    supported.push_back(pose);
  }
  const std::vector<Eigen::Affine2d> starts = keepDistinct(
      std::move(supported),
      [&](const Eigen::Affine2d& a, const Eigen::Affine2d& b) {
        return poseDistance(pairs.corners, a, b) < 3.0 * bin;
      },
      kCandidates);
  std::vector<VotedPlacement> drawn(starts.size());
  parallelFor(starts.size(), [&](std::size_t i) {
    drawn[i] = drawIn(matches, starts[i], axes, 2.0 * bin, options.tolerance * unit);
  });
  VotedPlacement best;
  for (VotedPlacement& placement : drawn) {
    if (placement.inliers.size() > best.inliers.size() &&
        allowed(placement.pose, space.uncertainty)) {
      best = std::move(placement);
    }
  }
  return best;
}

}  // namespace

std::vector<VotedPlacement> voteCoherent(std::span<const Match> matches, const SearchSpace& space,
                                         double cell, const VoteOptions& options) {
  const Eigen::Matrix2d axes = orthonormalAxes(space.scale_axes);
  if (options.kind == VoteKind::kDisplacement) {
    return voteDisplacement(matches, axes, cell, options);
  }
  // The next placement is sought among the matches that those before leave unexplained.
  std::vector<Match> left(matches.begin(), matches.end());
  std::vector<std::uint32_t> index(matches.size());
  std::iota(index.begin(), index.end(), 0U);
  std::vector<VotedPlacement> result;
  const auto least = static_cast<std::size_t>(options.least);
  while (result.size() < static_cast<std::size_t>(options.placements) && left.size() >= least) {
    VotedPlacement placement = bestPlacement(left, space, axes, options.step * cell, options);
    if (placement.inliers.size() < least) break;
    std::vector<bool> taken(left.size(), false);
    for (std::uint32_t& i : placement.inliers) {
      taken[i] = true;
      i = index[i];
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (taken[i]) continue;
      left[kept] = left[i];
      index[kept++] = index[i];
    }
    left.resize(kept);
    index.resize(kept);
    result.push_back(std::move(placement));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const VotedPlacement& a, const VotedPlacement& b) {
                     return a.inliers.size() > b.inliers.size();
                   });
  return result;
}

}  // namespace agricolmap::paper
