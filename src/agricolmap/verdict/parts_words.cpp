#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "agricolmap/verdict/parts.hpp"

namespace agricolmap::verdict {
namespace {

/// The nearest of eight directions, counted anticlockwise from east.
std::size_t eighth(const Eigen::Vector2d& direction) {
  const auto turns =
      std::lround(std::atan2(direction.y(), direction.x()) / (0.25 * std::numbers::pi));
  return static_cast<std::size_t>((turns + 8) % 8);
}

const char* where(const Eigen::Vector2d& direction) {
  constexpr std::array<const char*, 8> kNames = {"east", "north-east", "north", "north-west",
                                                 "west", "south-west", "south", "south-east"};
  return kNames[eighth(direction)];
}

std::string describe(const DisplacedPart& part, const PartsReport& report) {
  // Ends of parts are known to a slice.
  const double near = 0.02 * report.length;
  const bool low = part.begin <= near;
  const bool high = part.end >= report.length - near;
  std::string which;
  if (low && high) {
    which = "all of the strip";
  } else if (low || high) {
    which = fmt::format("the {:.1f} m at the strip's {}ern end", part.end - part.begin,
                        where(low ? Eigen::Vector2d(-report.along) : report.along));
  } else {
    which = fmt::format("{:.1f} m of the strip, {:.1f} m from its {}ern end,",
                        part.end - part.begin, part.begin, where(-report.along));
  }
  return fmt::format("{} lie {:.2f} m further {} than the whole says", which, part.offset.norm(),
                     where(part.offset));
}

}  // namespace

std::string describe(const PartsReport& levelled) {
  PartsReport report = levelled;
  const Eigen::Rotation2Dd back(-report.turn);
  report.along = back * report.along;
  for (DisplacedPart& part : report.displaced) part.offset = back * part.offset;
  const auto larger = [](const DisplacedPart& a, const DisplacedPart& b) {
    return a.offset.norm() * (a.end - a.begin) < b.offset.norm() * (b.end - b.begin);
  };
  const auto most = std::max_element(report.displaced.begin(), report.displaced.end(), larger);
  if (most == report.displaced.end()) return {};
  std::string text = describe(*most, report);
  const std::size_t more = report.displaced.size() - 1;
  if (more > 0) text += fmt::format(" (and {} more part{} elsewhere)", more, more > 1 ? "s" : "");
  return text;
}

}  // namespace agricolmap::verdict
