#include "agricolmap/io/las/las_lift.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace agricolmap::io {
namespace {

constexpr std::uint16_t kWktFlag = 0x10;

/// What both have in other places: returns, flags, class, user data, scan angle, source.
void liftFlags(const std::byte* from, std::byte* to) {
  constexpr double kAngleStep = 0.006;
  constexpr unsigned kOverlapClass = 12;
  constexpr unsigned kOverlapFlag = 0x08;
  const auto returns = std::to_integer<unsigned>(from[14]);
  const auto flags = std::to_integer<unsigned>(from[15]);
  unsigned classification = flags & 0x1FU;
  unsigned kept = flags >> 5;  // synthetic, key point, withheld
  if (classification == kOverlapClass) {
    classification = 1;
    kept |= kOverlapFlag;
  }
  to[14] = static_cast<std::byte>((returns & 0x07U) | (returns >> 3 & 0x07U) << 4);
  to[15] = static_cast<std::byte>(kept | (returns >> 6) << 6);  // with scan direction and edge
  to[16] = static_cast<std::byte>(classification);
  to[17] = from[17];
  const auto angle = static_cast<double>(loadLe<std::int8_t>(from + 16));
  storeLe(to + 18, static_cast<std::int16_t>(std::lround(angle / kAngleStep)));
  std::copy_n(from + 18, 2, to + 20);
}

}  // namespace

LasOutline lifted(LasOutline outline) {
  const LasLayout from = outline.layout;
  outline.layout = lasLayout(from.nir ? 8 : from.rgb ? 7 : 6);
  outline.layout.length += from.extraBytes();
  outline.minor = 4;
  outline.flags = static_cast<std::uint16_t>(outline.flags | kWktFlag);
  return outline;
}

void liftStandard(const std::byte* record, const LasLayout& layout, std::byte* to) {
  constexpr std::size_t kGpsTime = 22;
  std::copy_n(record, 14, to);  // coordinates and intensity
  if (layout.extended) {
    std::copy_n(record + 14, 8, to + 14);
  } else {
    liftFlags(record, to);
  }
  if (layout.gps_time) std::copy_n(record + *layout.gps_time, 8, to + kGpsTime);
}

std::vector<std::byte> lifted(const std::vector<std::byte>& records, const LasLayout& from,
                              const LasLayout& to) {
  const std::size_t count = records.size() / from.length;
  std::vector<std::byte> all(count * to.length);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* const source = &records[i * from.length];
    std::byte* const target = &all[i * to.length];
    liftStandard(source, from, target);
    if (from.rgb) std::copy_n(source + *from.rgb, 6, target + *to.rgb);
    if (from.nir) std::copy_n(source + *from.nir, 2, target + *to.nir);
    std::copy_n(source + from.base, from.extraBytes(), target + to.base);
  }
  return all;
}

}  // namespace agricolmap::io
