// What LAS has of a point beside its place, colour, source and time, passing by with the points.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "agricolmap/core/point_stream.hpp"

namespace agricolmap::io {

/// As point format 6 means it.
struct PointMarks {
  std::uint16_t intensity = 0;
  std::uint8_t returns = 0x11;  ///< which one, and of how many in the upper four bits
  std::uint8_t flags = 0;  ///< synthetic, key point, withheld, overlap, channel, direction, edge
  std::uint8_t classification = 0;
  std::uint8_t user = 0;
  std::int16_t scan_angle = 0;  ///< in steps of 0.006 degrees

  bool operator==(const PointMarks&) const = default;
};

/// As many marks as points, or none.
using MarkedVisit = std::function<void(const PointBatch&, std::span<const PointMarks>)>;

/// A cloud that may have marks.
class MarkedStream : public PointStream {
 public:
  virtual void passMarked(const MarkedVisit& visit) const = 0;
};

/// A pass over any cloud, with its marks where it is of LAS and was opened with them.
inline void passMarked(const PointStream& points, const MarkedVisit& visit) {
  if (const auto* const marked = dynamic_cast<const MarkedStream*>(&points)) {
    marked->passMarked(visit);
  } else {
    points.pass([&](const PointBatch& batch) { visit(batch, {}); });
  }
}

}  // namespace agricolmap::io
