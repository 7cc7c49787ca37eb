// Decoded points in a file without a name, for the passes after the first over a file whose
// decoding is dear.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/output/scratch_file.hpp"

namespace agricolmap::io {

/// Points by their number, 12 bytes each and 3 more for colours, in the scratch folder.
/// Everything throws OutputError. Can be written and read from several threads at once.
class PointSpill {
 public:
  /// Room for `points` of `source`, a name for messages.
  PointSpill(std::size_t points, bool coloured, const std::string& source);

  void write(std::size_t first, std::span<const Eigen::Vector3f> xyz, std::span<const Rgb> rgb);
  /// What was written to these places.
  void read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb) const;

 private:
  std::size_t coloursFrom(std::size_t first) const;
  std::size_t points_;
  ScratchFile file_;
};

}  // namespace agricolmap::io
