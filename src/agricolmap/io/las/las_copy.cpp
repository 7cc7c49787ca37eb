#include "agricolmap/io/las/las_copy.hpp"

#include <utility>

#include "agricolmap/io/las/copc_writer.hpp"
#include "agricolmap/io/las/las_feed.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/output/write_behind.hpp"

namespace agricolmap::io {
namespace {

/// Chunks that are decoded side by side before they are written.
constexpr std::size_t kTogether = 8;
/// Written between two times that the memory of the source is given back.
constexpr std::size_t kForgetAfter = std::size_t{1} << 26;

struct Piece {
  std::vector<std::byte> records;
  LasTally tally;
};

std::uint64_t writeFeed(const LasFeed& feed, const OutputPath& to, LasWriter::Points kind,
                        const CopyProgress& progress) {
  LasWriter writer(to, feed.outline(), kind);
  const LasLayout& layout = feed.outline().layout;
  std::size_t unforgotten = 0;
  feed.pass([&](std::size_t chunks, const LasFeed::Load& load) {
    writeBehind<Piece>(
        chunks, kTogether,
        [&](std::size_t chunk, Piece& piece) {
          load(chunk, piece.records);
          piece.tally = LasTally();
          piece.tally.add(piece.records.data(), piece.records.size() / layout.length, layout);
        },
        [&](const Piece& piece) {
          writer.write(piece.records.data(), piece.tally.points, piece.tally);
          unforgotten += piece.records.size();
          if (unforgotten < kForgetAfter) return;
          unforgotten = 0;
          feed.forget();
          if (progress) progress(writer.points(), feed.points());
        });
  });
  writer.close();
  return writer.points();
}

std::uint64_t writeAs(CloudFormat format, const LasFeed& feed, const OutputPath& to,
                      const CopyProgress& progress) {
  if (format == CloudFormat::kCopc) return writeCopc(feed, to, progress);
  const auto kind =
      format == CloudFormat::kLaz ? LasWriter::Points::kLaz : LasWriter::Points::kPlain;
  return writeFeed(feed, to, kind, progress);
}

}  // namespace

CopiedCloud copyLas(const std::filesystem::path& from, const OutputPath& to, CloudFormat format,
                    const std::optional<CloudMove>& move, const Crs& crs,
                    const CopyProgress& progress) {
  const auto feed = feedOf(from, move, move ? move->crs : crs, format == CloudFormat::kCopc);
  CopiedCloud copied;
  copied.warnings = feed->warnings;
  copied.points = writeAs(format, *feed, to, progress);
  copied.left_out = feed->points() - copied.points;
  return copied;
}

void writeLas(const OutputPath& path, const PointStream& points, CloudFormat format,
              const PointMove& target_from_file) {
  writeAs(format, *feedOf(points, target_from_file, path.shown()), path, {});
}

}  // namespace agricolmap::io
