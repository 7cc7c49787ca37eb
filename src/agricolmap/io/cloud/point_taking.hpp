// What points of a file become those of a cloud, where its origin is and what its colours mean: the
// same for clouds that are kept and for those that pass by.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

struct ColourRange {
  float low = 0.0F;
  float high = 0.0F;

  ColourRange& operator+=(const ColourRange& other);
};

/// What wide colours of such values are multiplied by to be 0–255, 1 for others; nothing where they
/// fit no range.
std::optional<float> colourScale(ColourKind kind, const ColourRange& range);

/// How points are taken.
struct Taking {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  float colour_scale = 1.0F;
};

/// A first look at a file: its origin, and the scale that its colours seem to have.
Taking firstLook(const PointSource& source);

/// Points of one chunk, or of all.
struct Tally {
  std::size_t kept = 0;
  std::size_t far = 0;  ///< that tell a place, but one too far from the origin
  std::size_t withheld = 0;
  ColourRange colours;  ///< of what was kept, where colours are wide

  Tally& operator+=(const Tally& other);
};
Tally sumOf(const std::vector<Tally>& tallies);

/// A few points of a cloud.
struct TakenPoints {
  std::size_t count = 0;
  std::array<Eigen::Vector3f, PointBlock::kCapacity> xyz;
  std::array<Rgb, PointBlock::kCapacity> rgb;  ///< undefined where the file has no colours
};

/// Hands those points of a chunk that are kept to `sink`, in order of the file.
Tally takeChunk(const PointSource& source, std::size_t chunk, const Taking& taking,
                const std::function<void(const TakenPoints&)>& sink);

/// The scale that the colours have, now that all were seen. Throws InputError where they fit no
/// known range.
float finalScale(const PointFile& file, const Tally& sum);

/// Whether there are colours: not when all of them are black and the format says that such are
/// none.
bool isColoured(const PointFile& file, const Tally& sum);

/// What is to be said of a file of which so much was kept, in the order in which it was found.
/// Throws InputError when no point is left or most are too far off.
std::vector<std::string> warningsOf(const PointFile& file, const Eigen::Vector3d& origin,
                                    const Tally& sum);

}  // namespace agricolmap::io
