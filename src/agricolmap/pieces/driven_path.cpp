#include "agricolmap/pieces/driven_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/map/blocks.hpp"

namespace agricolmap::pieces {
namespace {

constexpr double kSlice = 1.0;        ///< length along the strip [m]
constexpr double kLeastLength = 1.5;  ///< of a strip, in widths
/// A slice that is wider than most by this factor, or filled by less than this share, is more than
/// one track; so many of them may be for other reasons.
constexpr double kMostWidth = 1.6;
constexpr double kLeastFilled = 0.55;
constexpr double kOddSlices = 0.15;
/// A middle line that leaves the straight one by less, in widths, is straight.
constexpr double kStraight = 0.25;
constexpr double kTolerance = 0.03;  ///< corners nearer to the line between others go [m]
constexpr double kNear = 4.0;        ///< the robot saw what is so near to its path [m]
constexpr double kLeastNear = 0.5;   ///< share of the map
/// One cell in so many may lie before or behind the stretch that the map shows.
constexpr std::size_t kOddCells = 1000;
/// The path comes by again when it was so much farther on by then [m].
constexpr double kAgain = 6.0;

/// Douglas and Peucker: the corners from `first` to `last` that matter, but for `last`.
void simplify(const std::vector<Eigen::Vector2d>& corners, std::size_t first, std::size_t last,
              std::vector<Eigen::Vector2d>& kept) {
  const Eigen::Vector2d chord = corners[last] - corners[first];
  const double length2 = chord.squaredNorm();
  double farthest = 0.0;
  std::size_t at = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const Eigen::Vector2d arm = corners[i] - corners[first];
    const double t = length2 > 0.0 ? std::clamp(arm.dot(chord) / length2, 0.0, 1.0) : 0.0;
    const double off = (arm - t * chord).norm();
    if (off > farthest) farthest = off, at = i;
  }
  if (farthest <= kTolerance) {
    kept.push_back(corners[first]);
    return;
  }
  simplify(corners, first, at, kept);
  simplify(corners, at, last, kept);
}

deform::Path simplified(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Eigen::Vector2d> kept;
  simplify(corners, 0, corners.size() - 1, kept);
  kept.push_back(corners.back());
  return deform::Path(kept);
}

/// A slice across the strip.
struct Slice {
  double middle = 0.0;  ///< across [m]
  double width = 0.0;   ///< [m]
  double filled = 0.0;  ///< share of its area
};

std::vector<Slice> slicesOf(const map::SignalMap& map, const map::StripFrame& strip, int count) {
  std::vector<std::vector<double>> across(static_cast<std::size_t>(count));
  const double length = 2.0 * strip.half_extent.x();
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d p = strip.local(map.frame.centre(r, c));
      const auto i = static_cast<int>(std::floor((p.x() / length + 0.5) * count));
      if (i >= 0 && i < count) across[static_cast<std::size_t>(i)].push_back(p.y());
    }
  }
  std::vector<Slice> slices;
  for (std::vector<double>& values : across) {
    Slice slice;
    if (values.size() > 10) {
      const auto rank = [&](double share) {
        return static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
      };
      const double low = valueAtRank(values, rank(0.02)), high = valueAtRank(values, rank(0.98));
      slice.middle = 0.5 * (low + high);
      slice.width = high - low;
      const double area = std::max(slice.width, map.frame.cell) * length / count;
      slice.filled = static_cast<double>(values.size()) * map.frame.cell * map.frame.cell / area;
    }
    slices.push_back(slice);
  }
  return slices;
}

double medianWidth(const std::vector<Slice>& slices) {
  std::vector<double> widths;
  for (const Slice& slice : slices) {
    if (slice.width > 0.0) widths.push_back(slice.width);
  }
  return widths.empty() ? 0.0 : valueAtRank(widths, widths.size() / 2);
}

}  // namespace

ShapePath pathOfShape(const map::SignalMap& moving) {
  const map::StripFrame strip = map::stripFrame(moving);
  const double length = 2.0 * strip.half_extent.x();
  const int count = std::max(3, static_cast<int>(std::lround(length / kSlice)));
  const std::vector<Slice> slices = slicesOf(moving, strip, count);
  const double width = medianWidth(slices);
  constexpr const char* kRemedy = "give a path of the robot";
  if (width <= 0.0 || length < kLeastLength * width) {
    return {std::nullopt,
            fmt::format("the moving map is {:.1f} m long and {:.1f} m wide: its shape "
                        "does not tell how the robot drove; {}",
                        length, width, kRemedy)};
  }
  const auto odd = std::count_if(slices.begin(), slices.end(), [&](const Slice& slice) {
    return slice.width > kMostWidth * width || (slice.width > 0.0 && slice.filled < kLeastFilled);
  });
  if (static_cast<double>(odd) > kOddSlices * count) {
    return {
        std::nullopt,
        fmt::format("the moving map is no single track: where most of it is {:.1f} m wide, {} of "
                    "its {} metres are wider or have gaps; the robot's path cannot be told from "
                    "its shape; {}",
                    width, odd, count, kRemedy)};
  }
  std::vector<Eigen::Vector2d> middles;
  double farthest = 0.0;
  for (int i = 0; i < count; ++i) {
    const Slice& slice = slices[static_cast<std::size_t>(i)];
    if (slice.width <= 0.0) continue;
    farthest = std::max(farthest, std::abs(slice.middle));
    middles.push_back(strip.world({length * ((i + 0.5) / count - 0.5), slice.middle}));
  }
  if (farthest <= kStraight * width) return {deform::straightPath(strip), {}};
  return {simplified(middles), {}};
}

deform::Path pathThrough(const std::vector<Eigen::Vector2d>& places, const map::SignalMap& moving,
                         const std::string& name) {
  if (places.size() < 2) {
    throw InputError(fmt::format("{}: {} places; a path needs two at least", name, places.size()));
  }
  const deform::Path path = simplified(places);
  std::size_t seen = 0;
  std::vector<double> near;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      ++seen;
      const deform::PathPlace place = path.place(moving.frame.centre(r, c));
      if (std::abs(place.aside) <= kNear && place.along >= -kNear &&
          place.along <= path.length() + kNear) {
        near.push_back(place.along);
      }
    }
  }
  if (near.empty() || static_cast<double>(near.size()) < kLeastNear * static_cast<double>(seen)) {
    throw InputError(fmt::format(
        "{}: only {:.0f} % of the moving map lie within {} m of this path; it must be in the "
        "coordinates of the moving cloud's file",
        name,
        100.0 * static_cast<double>(near.size()) / std::max<double>(1.0, static_cast<double>(seen)),
        kNear));
  }
  // A trajectory may be of all the day.
  const std::size_t few = near.size() / kOddCells;
  const double from = valueAtRank(near, few), to = valueAtRank(near, near.size() - 1 - few);
  return to > from ? deform::stretchOf(path, from, to) : path;
}

double drivenTwice(const deform::Path& path, double distance) {
  std::vector<Eigen::Vector2d> places;
  const int count = std::max(2, static_cast<int>(path.length() / 0.5));
  const double step = path.length() / count;
  for (int i = 0; i <= count; ++i) places.push_back(path.point(step * i));
  const auto apart = static_cast<std::size_t>(kAgain / step) + 1;
  std::size_t again = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      if ((i > j ? i - j : j - i) < apart) continue;
      if ((places[i] - places[j]).norm() > distance) continue;
      ++again;
      break;
    }
  }
  return static_cast<double>(again) / static_cast<double>(places.size());
}

}  // namespace agricolmap::pieces
