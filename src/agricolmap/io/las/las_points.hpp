// The points of a LAS file as records, compressed or not.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "agricolmap/io/las/las_header.hpp"

namespace agricolmap::io {

/// What of a record is asked for; LAZ decodes some formats faster when it is little.
enum class LasWanted {
  kPlace,         ///< coordinates and flags
  kPlaceColours,  ///< and colours
  kAll,
};

/// Chunks can be decoded from several threads at once.
class LasPoints {
 public:
  /// Takes `count` records that follow each other.
  using Sink = std::function<void(const std::byte* records, std::size_t count)>;

  virtual ~LasPoints() = default;
  virtual std::size_t chunks() const = 0;
  /// Index of the chunk's first point.
  virtual std::size_t firstPoint(std::size_t chunk) const = 0;
  /// Hands all records of a chunk to `sink`, in the order of the file; what is not wanted of them
  /// is undefined. Throws InputError naming the file where the chunk is damaged.
  virtual void decode(std::size_t chunk, LasWanted wanted, const Sink& sink) const = 0;
};

/// The points of a file whose header was parsed; both must outlive them. Throws InputError, for LAZ
/// in a build without LASzip, too.
std::unique_ptr<LasPoints> lasPoints(std::span<const std::byte> bytes, const LasHeader& header,
                                     const std::string& name);

/// The same for LAZ alone, from laz_points.cpp or, in a build without LASzip, without_laszip.cpp.
std::unique_ptr<LasPoints> lazPoints(std::span<const std::byte> bytes, const LasHeader& header,
                                     const std::string& name);

}  // namespace agricolmap::io
