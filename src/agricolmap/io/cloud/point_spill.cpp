#include "agricolmap/io/cloud/point_spill.hpp"

#include <fmt/format.h>

namespace agricolmap::io {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

std::size_t bytesOf(std::size_t points, bool coloured) {
  return points * (sizeof(Eigen::Vector3f) + (coloured ? sizeof(Rgb) : 0));
}

}  // namespace

PointSpill::PointSpill(std::size_t points, bool coloured, const std::string& source)
    : points_(points),
      file_(scratchFolder(),
            fmt::format("{}: its decoded points need {:.1f} GiB for a while in {}", source,
                        static_cast<double>(bytesOf(points, coloured)) / kGiB, scratchFolder()),
            "name another folder in TMPDIR, or convert the file to LAS, which needs no room") {
  file_.reserve(bytesOf(points, coloured));
}

std::size_t PointSpill::coloursFrom(std::size_t first) const {
  return bytesOf(points_, false) + first * sizeof(Rgb);
}

void PointSpill::write(std::size_t first, std::span<const Eigen::Vector3f> xyz,
                       std::span<const Rgb> rgb) {
  file_.write(bytesOf(first, false), std::as_bytes(xyz));
  file_.write(coloursFrom(first), std::as_bytes(rgb));
}

void PointSpill::read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb) const {
  file_.read(bytesOf(first, false), std::as_writable_bytes(xyz));
  file_.read(coloursFrom(first), std::as_writable_bytes(rgb));
}

}  // namespace agricolmap::io
