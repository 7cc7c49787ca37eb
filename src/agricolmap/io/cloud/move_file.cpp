#include "agricolmap/io/cloud/move_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/pcd_header.hpp"
#include "agricolmap/io/cloud/ply_header.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuseFar(const std::string& file, std::uint64_t far, std::uint64_t points) {
  throw InputError(fmt::format(
      "{}: {} of its {} points lie more than {:.0f} km from the strip that was registered; check "
      "its units and its coordinate system",
      file, far, points, kMaxFromOrigin / 1000.0));
}

}  // namespace

bool keepsAttributes(CloudFormat from, CloudFormat to) {
  return from == to || (isLas(from) && isLas(to));
}

CloudFormat formatOf(const std::filesystem::path& file) {
  const auto format = formatByContent(MappedFile(file).text());
  if (format) return *format;
  readCloud(file, {false, nullptr});  // says what it is instead
  throw InputError(fmt::format("{}: is no cloud", file.string()));
}

std::uint64_t pointsOf(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const std::string name = file.string();
  switch (formatOf(file)) {
    case CloudFormat::kPcd:
      return parsePcdHeader(withoutMark(mapped.text()), name).points;
    case CloudFormat::kPly:
      return vertexOf(parsePlyHeader(withoutMark(mapped.text()), name), name).count;
    case CloudFormat::kXyz:
      return 0;
    case CloudFormat::kLas:
    case CloudFormat::kLaz:
    case CloudFormat::kCopc:
      break;
  }
  return parseLasHeader(mapped.bytes(), name).points;
}

void noteTally(const MoveTally& tally, const std::string& file, CopiedCloud& copied) {
  if (tally.far > copied.points / 2) refuseFar(file, tally.far, copied.points);
  if (tally.nowhere == 0) return;
  copied.warnings.push_back(
      fmt::format("{}: {} points have no place in the coordinate system of the fixed cloud; they "
                  "become NaN",
                  file, tally.nowhere));
}

void noteDouble(const PointMover& mover, const std::string& file, CopiedCloud& copied) {
  copied.warnings.push_back(
      mover.needsDouble()
          ? fmt::format(
                "{}: coordinates are written as doubles: 32-bit floats would be in steps of "
                "{:.3f} m where it comes to lie",
                file, mover.floatStep())
          : fmt::format("{}: coordinates are written as doubles instead of integers", file));
}

CopiedCloud moveFile(const std::filesystem::path& from, const OutputPath& to, CloudFormat format,
                     const CloudMove& move, const CopyProgress& progress) {
  const CloudFormat own = formatOf(from);
  if (isLas(own) && isLas(format)) {
    CopiedCloud copied = copyLas(from, to, format, move, {}, progress);
    if (copied.left_out > copied.points) {
      refuseFar(from.string(), copied.left_out, copied.left_out + copied.points);
    }
    return copied;
  }
  if (own == format && own == CloudFormat::kPcd) return movePcd(from, to, move, progress);
  const bool listed = own == format;
  if (listed) {
    if (auto copied = movePly(from, to, move, progress)) return *std::move(copied);
  }
  Cloud cloud = readCloud(from, {true, move.map});
  if ((cloud.origin - move.origin).cwiseAbs().maxCoeff() > kMaxFromOrigin) {
    refuseFar(from.string(), cloud.size(), cloud.size());
  }
  cloud.crs = move.crs;
  writeCloud(to, cloud, format, move.target_from_file);
  CopiedCloud copied{cloud.size(), cloud.dropped_points, std::move(cloud.warnings)};
  if (listed) {
    copied.warnings.push_back(fmt::format(
        "{}: its vertices have lists, or elements with lists before them: nothing but coordinates "
        "and colours is kept",
        from.string()));
  }
  return copied;
}

}  // namespace agricolmap::io
