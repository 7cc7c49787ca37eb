// Point clouds of any size: their points pass by and are not kept.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/read_options.hpp"

namespace agricolmap::io {

struct StreamOptions {
  ReadOptions read;
  /// Clouds of no more points are read once and kept: 240 MiB.
  std::size_t keep = std::size_t{1} << 24;
  /// Hears how many points of how many a pass has seen, from the thread that passes.
  std::function<void(std::size_t seen, std::size_t of)> on_pass;
  Crs crs;                 ///< to be the cloud's
  std::string shown = {};  ///< what messages call the file; empty: its path
};

/// The points that `readCloud` would give, to the bit, as a stream. A file is decoded anew for each
/// pass; what is compressed, text or reprojected only once, into a file without a name in TMPDIR,
/// else in /var/tmp, of 15 bytes a point, 23 with marks; a cloud that has these is never kept.
/// Throws InputError as readCloud does, here or in a pass, for a file that is changed meanwhile,
/// too; OutputError where the decoded points find no room.
std::unique_ptr<PointStream> streamCloud(const std::filesystem::path& path,
                                         const StreamOptions& options = {});

/// Enough to be kept where a cloud passes by a few times only: 60 MiB.
inline constexpr std::size_t kKeepLittle = std::size_t{1} << 22;

/// What a stream of the file would say of itself, after one look at all of its points, two where
/// colours or heights turn out otherwise than they seemed; nothing is kept or spilled. Throws
/// InputError as readCloud does.
CloudFacts factsOfFile(const std::filesystem::path& path, const StreamOptions& options = {});

/// The points of a cloud that is kept, by the stream.
std::unique_ptr<PointStream> keptStream(Cloud cloud);

}  // namespace agricolmap::io
