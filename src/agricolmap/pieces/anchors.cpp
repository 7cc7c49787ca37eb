#include "agricolmap/pieces/anchors.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::pieces {
namespace {

constexpr std::size_t kAnchors = 3;
/// A piece that shows less than this share of what the most telling one does waits.
constexpr double kTelling = 0.5;

}  // namespace

std::vector<double> anchorsOf(const deform::Path& path, const map::SignalMap& signals,
                              double length, bool middle_first) {
  const double step = 0.5 * std::min(length, path.length());
  const auto count =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(path.length() / step)) - 1);
  const double even = path.length() / static_cast<double>(count + 1);
  std::vector<double> energy(count + 1, 0.0);
  for (int r = 0; r < signals.frame.rows; ++r) {
    for (int c = 0; c < signals.frame.cols; ++c) {
      if (signals.weight(r, c) <= 0.0F) continue;
      const double at = path.place(signals.frame.centre(r, c)).along / even;
      const auto half = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(count)));
      for (const Raster<float>& channel : signals.channel) {
        energy[half] += static_cast<double>(channel(r, c)) * static_cast<double>(channel(r, c));
      }
    }
  }
  struct Candidate {
    double along, energy, off;
    bool telling;
  };
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double along = even * static_cast<double>(i + 1);
    all.push_back({along, energy[i] + energy[i + 1], std::abs(along - 0.5 * path.length()), false});
  }
  const double most = std::max_element(all.begin(), all.end(), [](const auto& a, const auto& b) {
                        return a.energy < b.energy;
                      })->energy;
  for (Candidate& one : all) one.telling = one.energy >= kTelling * most;
  std::stable_sort(all.begin(), all.end(), [&](const Candidate& a, const Candidate& b) {
    if (a.telling != b.telling) return a.telling;
    if (a.telling && middle_first) return a.off < b.off;
    return a.energy > b.energy;
  });
  std::vector<double> anchors;
  for (const Candidate& one : all) {
    const bool apart = std::all_of(anchors.begin(), anchors.end(), [&](double other) {
      return std::abs(other - one.along) >= length;
    });
    if (apart && anchors.size() < kAnchors) anchors.push_back(one.along);
  }
  return anchors;
}

}  // namespace agricolmap::pieces
