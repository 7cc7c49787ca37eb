// Where the records of a LAS file to be written come from: another LAS file, or points that pass
// by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_move.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

class LasFeed {
 public:
  virtual ~LasFeed() = default;
  /// Of the file to be written.
  const LasOutline& outline() const { return outline_; }
  virtual std::uint64_t points() const = 0;  ///< that there are, those left out included
  /// Replaces `records` by those of a chunk, moved, in the outline's layout. From several threads
  /// at once. Throws InputError naming the file where the chunk is damaged.
  using Load = std::function<void(std::size_t chunk, std::vector<std::byte>& records)>;
  /// Takes chunks 0 to `chunks` - 1, which can be loaded until it returns.
  using Visit = std::function<void(std::size_t chunks, const Load& load)>;
  /// Hands all points to `visit`, in their order: at once, or some after the others where not all
  /// of them can be looked at when one likes. The same chunks each time.
  virtual void pass(const Visit& visit) const = 0;
  /// What was loaded is not needed soon.
  virtual void forget() const {}
  std::vector<std::string> warnings;  ///< what could not be taken along

 protected:
  LasOutline outline_;
};

/// All records of a LAS or LAZ file. `crs`: instead of what it says of its own, unless empty.
/// `extended`: lifted to the point formats 6 to 8, as COPC has them. Without `move` coordinates
/// stay as they are; with it they are written in the steps of the source where these are metres and
/// between 10 µm and 1 cm, else in millimetres.
std::unique_ptr<LasFeed> feedOf(const std::filesystem::path& file,
                                const std::optional<CloudMove>& move, const Crs& crs,
                                bool extended);

/// The points of a stream, in the coordinates of its file, moved: millimetres, colours in 16 bit.
/// The stream must outlive it. `name`: of the file to be written, for messages.
std::unique_ptr<LasFeed> feedOf(const PointStream& points, const PointMove& target_from_file,
                                std::string name);

}  // namespace agricolmap::io
