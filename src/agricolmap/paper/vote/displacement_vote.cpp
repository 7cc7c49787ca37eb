#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "agricolmap/paper/vote/coherent_vote.hpp"

namespace agricolmap::paper {
namespace {

/// A square of displacements and the matches in it.
struct Bin {
  std::array<int, 2> place{};
  std::vector<std::uint32_t> matches;
};

/// The bins that hold matches, fullest first.
std::vector<Bin> binsOf(std::span<const Match> matches, double step) {
  std::vector<std::pair<std::array<int, 2>, std::uint32_t>> places;
  places.reserve(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Eigen::Vector2d d = (matches[i].fixed - matches[i].moving) / step;
    places.push_back({{static_cast<int>(std::floor(d.x())), static_cast<int>(std::floor(d.y()))},
                      static_cast<std::uint32_t>(i)});
  }
  std::sort(places.begin(), places.end());
  std::vector<Bin> bins;
  for (const auto& [place, match] : places) {
    if (bins.empty() || bins.back().place != place) bins.push_back({place, {}});
    bins.back().matches.push_back(match);
  }
  std::stable_sort(bins.begin(), bins.end(),
                   [](const Bin& a, const Bin& b) { return a.matches.size() > b.matches.size(); });
  return bins;
}

bool touches(const Bin& a, const Bin& b) {
  return std::abs(a.place[0] - b.place[0]) <= 1 && std::abs(a.place[1] - b.place[1]) <= 1;
}

ScaledRotation poseOf(std::span<const Match> matches, const Bin& bin, const Eigen::Matrix2d& axes) {
  std::vector<Match> chosen;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (const std::uint32_t i : bin.matches) {
    chosen.push_back(matches[i]);
    shift += matches[i].fixed - matches[i].moving;
  }
  if (const auto fit = fitScaledRotation(chosen, {}, axes)) return *fit;
  ScaledRotation pose;
  pose.fixed_from_moving.translation() = shift / static_cast<double>(chosen.size());
  return pose;
}

}  // namespace

std::vector<VotedPlacement> voteDisplacement(std::span<const Match> matches,
                                             const Eigen::Matrix2d& axes, double cell,
                                             const VoteOptions& options) {
  std::vector<const Bin*> chosen;
  std::vector<VotedPlacement> result;
  const std::vector<Bin> bins = binsOf(matches, options.step * cell);
  for (const Bin& bin : bins) {
    if (result.size() == static_cast<std::size_t>(options.placements) ||
        bin.matches.size() < static_cast<std::size_t>(options.least)) {
      break;
    }
    const bool beside = std::any_of(chosen.begin(), chosen.end(),
                                    [&](const Bin* fuller) { return touches(bin, *fuller); });
    if (beside) continue;
    chosen.push_back(&bin);
    result.push_back({poseOf(matches, bin, axes), bin.matches});
  }
  return result;
}

}  // namespace agricolmap::paper
