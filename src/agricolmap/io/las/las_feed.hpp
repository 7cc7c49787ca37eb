// Where the records of a LAS file to be written come from: another LAS file, or a cloud.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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
  virtual std::size_t chunks() const = 0;
  /// Replaces `records` by those of a chunk, moved, in the outline's layout. From several threads
  /// at once. Throws InputError naming the file where the chunk is damaged.
  virtual void load(std::size_t chunk, std::vector<std::byte>& records) const = 0;
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

/// A cloud's points, in the coordinates of its file, moved: millimetres, colours in 16 bit. The
/// cloud must outlive it. `name`: of the file to be written, for messages.
std::unique_ptr<LasFeed> feedOf(const Cloud& cloud, const PointMove& target_from_file,
                                std::string name);

}  // namespace agricolmap::io
