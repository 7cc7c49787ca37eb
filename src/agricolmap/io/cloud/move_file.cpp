#include "agricolmap/io/cloud/move_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuseFar(const std::string& file, std::uint64_t far, std::uint64_t points) {
  throw InputError(fmt::format(
      "{}: {} of its {} points lie more than {:.0f} km from the strip that was registered; check "
      "its units and its coordinate system",
      file, far, points, kMaxFromOrigin / 1000.0));
}

/// Where formats have coordinates and colours alone in common.
CopiedCloud rewriteFile(const std::filesystem::path& from, const OutputPath& to, CloudFormat format,
                        const CloudMove& move, const CopyProgress& progress) {
  const auto points = streamCloud(from, {{true, move.map}, kKeepLittle, progress, move.crs});
  const CloudFacts& facts = points->facts();
  if ((facts.origin - move.origin).cwiseAbs().maxCoeff() > kMaxFromOrigin) {
    refuseFar(from.string(), facts.points, facts.points);
  }
  writeCloud(to, *points, format, move.target_from_file);
  return {facts.points, facts.dropped_points, facts.warnings};
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
  CopiedCloud copied = rewriteFile(from, to, format, move, progress);
  if (listed) {
    copied.warnings.push_back(fmt::format(
        "{}: its vertices have lists, or elements with lists before them: nothing but coordinates "
        "and colours is kept",
        from.string()));
  }
  return copied;
}

}  // namespace agricolmap::io
