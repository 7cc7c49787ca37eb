#include "agricolmap/locate/candidates.hpp"

#include <algorithm>
#include <array>

namespace agricolmap::locate {
namespace {

/// The strip's corners where a candidate puts them [m].
using Corners = std::array<Eigen::Vector2d, 4>;

Corners cornersOf(const Candidate& candidate, const map::StripFrame& strip,
                  const SearchSpace& space) {
  const Eigen::Affine2d pose = poseOf(candidate, space);
  Corners corners = strip.corners();
  for (Eigen::Vector2d& corner : corners) corner = pose * corner;
  return corners;
}

bool near(const Corners& a, const Corners& b, double separation) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a[i] - b[i]).squaredNorm() >= separation * separation) return false;
  }
  return true;
}

}  // namespace

std::vector<Candidate> distinctCandidates(std::vector<Candidate> all, int most, double separation,
                                          const map::StripFrame& strip, const SearchSpace& space) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> kept;
  std::vector<Corners> corners;
  for (const Candidate& candidate : all) {
    if (static_cast<int>(kept.size()) >= most) break;
    const Corners here = cornersOf(candidate, strip, space);
    const bool is_new = std::none_of(corners.begin(), corners.end(), [&](const Corners& other) {
      return near(here, other, separation);
    });
    if (!is_new) continue;
    kept.push_back(candidate);
    corners.push_back(here);
  }
  return kept;
}

}  // namespace agricolmap::locate
