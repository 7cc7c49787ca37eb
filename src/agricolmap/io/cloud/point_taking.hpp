// What points of a file become those of a cloud, where its origin is, what its colours mean and
// which height stands for none: the same for clouds that are kept and for those that pass by.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/io/cloud/colour_scale.hpp"
#include "agricolmap/io/cloud/hole_height.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

/// How points are taken.
struct Taking {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  ColourScale colours;
  std::optional<double> hole;  ///< the height that stands for none

  bool operator==(const Taking& other) const {
    return origin == other.origin && colours.factor == other.colours.factor && hole == other.hole;
  }
};

/// What a few points of a file say.
struct FirstLook {
  Taking taking;                ///< as it seems
  std::vector<double> heights;  ///< of some points, holes included
};
FirstLook firstLook(const PointSource& source);

/// Points of one chunk, or of all.
struct Tally {
  std::size_t kept = 0;
  std::size_t far = 0;  ///< that tell a place, but one too far from the origin
  std::size_t withheld = 0;
  std::size_t off_colour = 0;  ///< whose wide colours are outside the range of the others
  std::size_t holes = 0;
  ColourTally colours;    ///< of what can be used, where colours are wide
  LowestHeights heights;  ///< of what is near enough to the origin

  Tally& operator+=(const Tally& other);
};
Tally sumOf(const std::vector<Tally>& tallies);

/// A few points of a cloud.
struct TakenPoints {
  std::size_t count = 0;
  std::array<Eigen::Vector3f, PointBlock::kCapacity> xyz;
  std::array<Rgb, PointBlock::kCapacity> rgb;           ///< undefined where the file has no colours
  std::array<PointMarks, PointBlock::kCapacity> marks;  ///< of a source that has some
};

/// Hands those points of a chunk that are kept to `sink`, in order of the file.
Tally takeChunk(const PointSource& source, std::size_t chunk, const Taking& taking,
                const std::function<void(const TakenPoints&)>& sink);

/// How points are to be taken, now that all were seen: nearly always as it seemed; where not, they
/// must be taken again. Throws InputError where the colours fit no known range.
Taking finalTaking(const PointFile& file, const FirstLook& first, const Tally& sum);

/// Whether there are colours: not when all of them are black and the format says that such are
/// none.
bool isColoured(const PointFile& file, const Tally& sum);

/// What is to be said of a file of which so much was kept, in the order in which it was found.
/// Throws InputError when no point is left or most are too far off.
std::vector<std::string> warningsOf(const PointFile& file, const Taking& taking, const Tally& sum);

}  // namespace agricolmap::io
