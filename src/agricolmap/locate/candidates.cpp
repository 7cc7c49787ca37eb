#include "agricolmap/locate/candidates.hpp"

#include <algorithm>
#include <array>

#include "agricolmap/core/keep_distinct.hpp"

namespace agricolmap::locate {
namespace {

/// A candidate with where it puts the strip's corners [m].
struct Laid {
  Candidate candidate;
  std::array<Eigen::Vector2d, 4> corners;
};

Laid laid(const Candidate& candidate, const map::StripFrame& strip, const SearchSpace& space) {
  Laid result{candidate, strip.corners()};
  const Eigen::Affine2d pose = poseOf(candidate, space);
  for (Eigen::Vector2d& corner : result.corners) corner = pose * corner;
  return result;
}

bool near(const Laid& a, const Laid& b, double separation) {
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    if ((a.corners[i] - b.corners[i]).squaredNorm() >= separation * separation) return false;
  }
  return true;
}

}  // namespace

std::vector<Candidate> distinctCandidates(std::vector<Candidate> all, int most, double separation,
                                          const map::StripFrame& strip, const SearchSpace& space) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Laid> sorted;
  sorted.reserve(all.size());
  for (const Candidate& candidate : all) sorted.push_back(laid(candidate, strip, space));
  const std::vector<Laid> kept = keepDistinct(
      std::move(sorted), [&](const Laid& a, const Laid& b) { return near(a, b, separation); },
      static_cast<std::size_t>(most));
  std::vector<Candidate> distinct;
  distinct.reserve(kept.size());
  for (const Laid& one : kept) distinct.push_back(one.candidate);
  return distinct;
}

}  // namespace agricolmap::locate
