#include "agricolmap/io/cloud/point_spill.hpp"

#include <fmt/format.h>

namespace agricolmap::io {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

}  // namespace

std::size_t PointSpill::Kind::bytes(std::size_t points) const {
  return points * (sizeof(Eigen::Vector3f) + (coloured ? sizeof(Rgb) : 0) +
                   (marked ? sizeof(PointMarks) : 0));
}

PointSpill::PointSpill(std::size_t points, Kind kind, const std::string& source)
    : points_(points),
      kind_(kind),
      file_(scratchFolder(),
            fmt::format("{}: its decoded points need {:.3g} GiB for a while in {}", source,
                        static_cast<double>(kind.bytes(points)) / kGiB, scratchFolder()),
            "name a folder with room in TMPDIR") {
  file_.reserve(kind.bytes(points));
}

std::size_t PointSpill::coloursFrom(std::size_t first) const {
  return Kind{}.bytes(points_) + first * sizeof(Rgb);
}

std::size_t PointSpill::marksFrom(std::size_t first) const {
  return Kind{kind_.coloured, false}.bytes(points_) + first * sizeof(PointMarks);
}

void PointSpill::write(std::size_t first, std::span<const Eigen::Vector3f> xyz,
                       std::span<const Rgb> rgb, std::span<const PointMarks> marks) {
  file_.write(Kind{}.bytes(first), std::as_bytes(xyz));
  file_.write(coloursFrom(first), std::as_bytes(rgb));
  file_.write(marksFrom(first), std::as_bytes(marks));
}

void PointSpill::read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb,
                      std::span<PointMarks> marks) const {
  file_.read(Kind{}.bytes(first), std::as_writable_bytes(xyz));
  file_.read(coloursFrom(first), std::as_writable_bytes(rgb));
  file_.read(marksFrom(first), std::as_writable_bytes(marks));
}

}  // namespace agricolmap::io
