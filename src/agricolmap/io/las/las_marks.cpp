#include "agricolmap/io/las/las_marks.hpp"

#include <array>

#include "agricolmap/io/las/las_lift.hpp"

namespace agricolmap::io {
namespace {

// Where point format 6 has what.
constexpr std::size_t kStandard = 30;
constexpr std::size_t kIntensity = 12, kReturns = 14, kFlags = 15, kClass = 16, kUser = 17;
constexpr std::size_t kScanAngle = 18;

}  // namespace

PointMarks marksOf(const std::byte* record, const LasLayout& layout) {
  std::array<std::byte, kStandard> standard{};
  liftStandard(record, layout, standard.data());
  return {
      loadLe<std::uint16_t>(&standard[kIntensity]), loadLe<std::uint8_t>(&standard[kReturns]),
      loadLe<std::uint8_t>(&standard[kFlags]),      loadLe<std::uint8_t>(&standard[kClass]),
      loadLe<std::uint8_t>(&standard[kUser]),       loadLe<std::int16_t>(&standard[kScanAngle])};
}

void storeMarks(const PointMarks& marks, std::byte* record) {
  storeLe(record + kIntensity, marks.intensity);
  storeLe(record + kReturns, marks.returns);
  storeLe(record + kFlags, marks.flags);
  storeLe(record + kClass, marks.classification);
  storeLe(record + kUser, marks.user);
  storeLe(record + kScanAngle, marks.scan_angle);
}

}  // namespace agricolmap::io
