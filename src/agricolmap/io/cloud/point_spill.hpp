// Decoded points in a file without a name, for the passes after the first over a file whose
// decoding is dear.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "agricolmap/core/cloud.hpp"

namespace agricolmap::io {

/// Points by their number, 12 bytes each and 3 more for colours, in the folder that TMPDIR names,
/// else in /var/tmp (/tmp may be memory). The file has no name and ends with this, however the
/// program does. Can be written and read from several threads at once.
class PointSpill {
 public:
  /// Room for `points` of `source`, a name for messages. Throws OutputError where there is none.
  PointSpill(std::size_t points, bool coloured, const std::string& source);
  ~PointSpill();
  PointSpill(const PointSpill&) = delete;
  PointSpill& operator=(const PointSpill&) = delete;

  /// Throws OutputError.
  void write(std::size_t first, std::span<const Eigen::Vector3f> xyz, std::span<const Rgb> rgb);
  /// What was written to these places. Throws InputError.
  void read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb) const;

 private:
  [[noreturn]] void failToWrite() const;
  std::size_t points_;
  std::string source_;
  std::string folder_;
  int fd_ = -1;
};

}  // namespace agricolmap::io
