// How QGIS is to show what is written, in its own words (QML): else a file of three bands becomes a
// picture of three colours, and squares hide the map below them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace agricolmap::report {

/// Values of a band between two colours; beyond them the nearest one's.
struct RampStyle {
  int band = 1;
  double low = 0.0;
  double high = 1.0;
  std::span<const std::uint32_t> stops;  ///< 0xRRGGBB, evenly spaced
  std::string unit;
};
std::string qgisRamp(const RampStyle& style);

/// What a number in the first band stands for.
struct CodeStyle {
  int code = 0;
  std::uint32_t colour = 0;
  std::string label;
};
std::string qgisCodes(const std::vector<CodeStyle>& codes);

/// Of a layer of `facts`, by its name; nothing for names that it does not know. Seen on a white
/// page as on the field's colours.
std::string qgisMarks(std::string_view layer);

/// Of areas that are filled by how much something changed, from brown (fell) to green (rose).
struct ChangeShades {
  std::string change;  ///< an expression over the layer's fields; null: not known
  /// Another one that is 1 where the change is more than errors, else 0: these are grey. Empty:
  /// nobody can tell.
  std::string sure = {};
  double reach = 1.0;  ///< of the colours; beyond it the outermost
  /// Of labels: "{:+.1f} cm" of 100 times the change.
  double factor = 1.0;
  int digits = 1;
  std::string unit = {};
};
std::string qgisChange(const ChangeShades& shades);

}  // namespace agricolmap::report
