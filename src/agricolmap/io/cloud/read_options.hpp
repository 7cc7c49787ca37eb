// What of a cloud's file is read, and what becomes of its coordinates.
#pragma once

#include <cstddef>

namespace agricolmap::io {

/// Brings the coordinates of a file into others: another projection, metres instead of feet.
class CoordinateMap {
 public:
  virtual ~CoordinateMap() = default;
  /// In place, from several threads at once. A point that has no image becomes infinite.
  virtual void apply(double* x, double* y, double* z, std::size_t count) const = 0;
};

struct ReadOptions {
  bool colours = true;                 ///< read colours where the file has them
  const CoordinateMap* map = nullptr;  ///< applied in double before anything else
  bool marks = false;                  ///< of LAS, for `passMarked`; a Cloud has none
};

}  // namespace agricolmap::io
