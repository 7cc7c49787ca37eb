// Decoded points in a file without a name, for the passes after the first over a file whose
// decoding is dear.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/point_marks.hpp"
#include "agricolmap/io/output/scratch_file.hpp"

namespace agricolmap::io {

/// Points by their number, 12 bytes each, 3 more for colours and 8 for marks, in the scratch
/// folder. Everything throws OutputError. Can be written and read from several threads at once.
class PointSpill {
 public:
  /// What it has of a point beside its place.
  struct Kind {
    bool coloured = false;
    bool marked = false;

    std::size_t bytes(std::size_t points) const;
  };
  /// Room for `points` of `source`, a name for messages.
  PointSpill(std::size_t points, Kind kind, const std::string& source);

  void write(std::size_t first, std::span<const Eigen::Vector3f> xyz, std::span<const Rgb> rgb,
             std::span<const PointMarks> marks);
  /// What was written to these places; colours and marks may be left out.
  void read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb,
            std::span<PointMarks> marks) const;

 private:
  std::size_t coloursFrom(std::size_t first) const;
  std::size_t marksFrom(std::size_t first) const;
  std::size_t points_;
  Kind kind_;
  ScratchFile file_;
};

}  // namespace agricolmap::io
