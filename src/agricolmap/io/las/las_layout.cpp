#include "agricolmap/io/las/las_layout.hpp"

#include <fmt/format.h>

namespace agricolmap::io {
namespace {

constexpr std::size_t kShortPoint = 20;     ///< formats 0 to 5
constexpr std::size_t kExtendedPoint = 30;  ///< formats 6 to 10, the time included
constexpr std::size_t kTime = 8;
constexpr std::size_t kColour = 6;
constexpr std::size_t kInfrared = 2;
constexpr std::size_t kWave = 29;

}  // namespace

LasLayout lasLayout(int format) {
  LasLayout layout;
  layout.format = format;
  layout.extended = format >= 6;
  std::size_t end = layout.extended ? kExtendedPoint : kShortPoint;
  const auto take = [&](bool has, std::size_t bytes) -> std::optional<std::size_t> {
    if (!has) return std::nullopt;
    end += bytes;
    return end - bytes;
  };
  if (layout.extended) {
    layout.gps_time = kExtendedPoint - kTime;
  } else {
    layout.gps_time = take(format != 0 && format != 2, kTime);
  }
  layout.rgb =
      take(format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10,
           kColour);
  layout.nir = take(format == 8 || format == 10, kInfrared);
  layout.wave = take(format == 4 || format == 5 || format == 9 || format == 10, kWave);
  layout.base = end;
  layout.length = end;
  return layout;
}

std::string lasFields(const LasLayout& layout) {
  std::string fields = "x, y, z, intensity, returns, classification, scan angle, user data, source";
  if (layout.gps_time) fields += ", GPS time";
  if (layout.rgb) fields += ", red, green, blue";
  if (layout.nir) fields += ", near infrared";
  if (layout.wave) fields += ", wave packet";
  if (layout.extraBytes() > 0) fields += fmt::format(", {} extra bytes", layout.extraBytes());
  return fields;
}

}  // namespace agricolmap::io
