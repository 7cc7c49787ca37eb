#include "agricolmap/report/gis/layer_styles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/report/draw/ramp.hpp"
#include "agricolmap/report/gis/qgis_style.hpp"

namespace agricolmap::report {
namespace {

constexpr double kGreen = 0.4;  // of Excess Green
constexpr double kLeastHeight = 0.05, kLeastError = 0.01, kLeastDensity = 1.0;

/// Some of the known values, which are enough for what follows.
std::vector<float> sampleOf(const Raster<float>& values) {
  constexpr std::size_t kSamples = 100'000;
  std::vector<float> some;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSamples);
  for (std::size_t i = 0; i < values.size(); i += step) {
    if (!std::isnan(values[i])) some.push_back(values[i]);
  }
  return some;
}

constexpr double kHardlyMore = 0.98;

/// What hardly a cell surpasses, at least `least`.
double most(const Raster<float>& values, double least) {
  std::vector<float> some = sampleOf(values);
  return some.empty() ? least : std::max<double>(least, quantile(some, kHardlyMore));
}

/// Of the first band, heights as they stand in the file.
std::string surfaceStyle(const fuse::Layers& layers) {
  std::vector<float> some = sampleOf(layers.surface);
  if (some.empty()) some = {0.0F};
  const double up = layers.origin.z();
  const double low = up + static_cast<double>(quantile(some, 1.0 - kHardlyMore));
  const double high = up + static_cast<double>(quantile(some, kHardlyMore));
  return qgisRamp({1, low, std::max(high, low + kLeastHeight), kLowToHigh, "m"});
}

std::string upTo(double high, const char* unit) {
  return qgisRamp({1, 0.0, high, kLowToHigh, unit});
}

/// The drone's map grey, strips in colours that are told apart by all.
std::string sourceStyle(const fuse::SharedMap& map) {
  constexpr std::array<std::uint32_t, 7> kStrips{0xe69f00, 0x56b4e9, 0x009e73, 0xf0e442,
                                                 0x0072b2, 0xd55e00, 0xcc79a7};
  std::vector<CodeStyle> codes{{fuse::kFixedSource, 0xb0bec5, "drone"}};
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    codes.push_back({map.strips[i].code, kStrips[i % kStrips.size()], map.strips[i].id});
  }
  return qgisCodes(codes);
}

}  // namespace

void writeMapStyles(const std::function<io::OutputPath(const std::string& name)>& place,
                    const fuse::SharedMap& map) {
  const auto write = [&](const std::string& name, const std::string& style) {
    io::writeText(place(name + ".qml"), style);
  };
  const fuse::Layers& layers = map.layers;
  const std::string heights = upTo(map.flat ? 1.0 : most(layers.plant_height, kLeastHeight), "m");
  const std::string density = upTo(most(layers.density, kLeastDensity), "1/m2");
  const auto writeValues = [&](const std::string& folder) {
    write(folder + "exg", upTo(kGreen, ""));
    write(folder + "cover", upTo(1.0, ""));
    write(folder + "density", density);
    if (!map.flat) write(folder + "plant_height", heights);
  };
  writeValues("layers/");
  write("layers/error", upTo(most(layers.plane_error, kLeastError), "m"));
  write("layers/source", sourceStyle(map));
  bool fine = false;
  for (const fuse::FusedStrip& strip : map.strips) {
    if (strip.owned_area <= 0.0) continue;
    fine = true;
    // Of four bands the first is shown: plant heights, or, where there are none, the next one.
    const bool flat = map.flat || strip.flat;
    write("fine/" + strip.id, flat ? qgisRamp({2, 0.0, kGreen, kLowToHigh, ""}) : heights);
    if (!flat) write("fine/" + strip.id + "_heights", surfaceStyle(layers));
  }
  if (fine) writeValues("fine/");  // of the mosaics
}

void writeChangeStyle(const io::OutputPath& dir, const std::string& name, double reach,
                      const std::string& unit) {
  io::writeText(dir / (name + ".qml"), qgisRamp({1, -reach, reach, kFallToRise, unit}));
}

}  // namespace agricolmap::report
