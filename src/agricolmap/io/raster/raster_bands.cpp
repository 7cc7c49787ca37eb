#include "agricolmap/io/raster/raster_bands.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr double kMetreTolerance = 1e-6;
constexpr std::size_t kSamples = 1U << 16;

/// The words of a band's name: "Red edge (717 nm)" is red, edge and nm.
std::set<std::string> wordsOf(GDALRasterBand& band) {
  std::string text = lowerCase(band.GetDescription());
  for (char& c : text) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) c = ' ';
  }
  const std::vector<std::string_view> words = splitWords(text);
  return {words.begin(), words.end()};
}

std::string namesOf(GDALDataset& dataset) {
  std::string names;
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const std::string name = dataset.GetRasterBand(i)->GetDescription();
    names += (names.empty() ? "" : ", ") + (name.empty() ? fmt::format("band {}", i) : name);
  }
  return names;
}

/// By their names; nothing where none is named after a colour.
std::optional<ColourBands> byNames(GDALDataset& dataset, const std::string& name) {
  static constexpr std::array<std::pair<const char*, const char*>, 3> kColours{
      {{"red", "r"}, {"green", "g"}, {"blue", "b"}}};
  ColourBands bands{};
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    GDALRasterBand* const band = dataset.GetRasterBand(i);
    const std::set<std::string> words = wordsOf(*band);
    if (words.count("edge") + words.count("nir") + words.count("mask") > 0) continue;
    for (std::size_t c = 0; c < kColours.size(); ++c) {
      const bool named = words.count(kColours[c].first) + words.count(kColours[c].second) > 0;
      if (named && bands[c] == nullptr) bands[c] = band;
    }
  }
  const auto found =
      std::count_if(bands.begin(), bands.end(), [](auto* b) { return b != nullptr; });
  if (found == 0) return std::nullopt;
  if (found < 3) {
    throw InputError(fmt::format("{}: its bands are {}; an orthomosaic needs red, green and blue",
                                 name, namesOf(dataset)));
  }
  return bands;
}

/// By what the file declares; nothing where it does not say all three.
std::optional<ColourBands> byDeclaration(GDALDataset& dataset) {
  ColourBands bands{};
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    const int channel = dataset.GetRasterBand(i)->GetColorInterpretation() - GCI_RedBand;
    if (channel < 0 || channel > 2) continue;
    auto& band = bands[static_cast<std::size_t>(channel)];
    if (band == nullptr) band = dataset.GetRasterBand(i);
  }
  if (std::any_of(bands.begin(), bands.end(), [](auto* b) { return b == nullptr; })) {
    return std::nullopt;
  }
  return bands;
}

/// Metres per unit of a name that programs write; nothing for others.
std::optional<double> metresPer(const std::string& unit) {
  constexpr double kFoot = 0.3048;
  constexpr double kSurveyFoot = 1200.0 / 3937.0;
  static constexpr std::array<std::pair<std::string_view, double>, 19> kUnits{
      {{"m", 1.0},
       {"metre", 1.0},
       {"metres", 1.0},
       {"meter", 1.0},
       {"meters", 1.0},
       {"ft", kFoot},
       {"foot", kFoot},
       {"feet", kFoot},
       {"international foot", kFoot},
       {"us survey foot", kSurveyFoot},
       {"us survey feet", kSurveyFoot},
       {"foot_us", kSurveyFoot},
       {"us-ft", kSurveyFoot},
       {"ftus", kSurveyFoot},
       {"sfoot", kSurveyFoot},
       {"sft", kSurveyFoot},
       {"dm", 0.1},
       {"cm", 0.01},
       {"mm", 0.001}}};
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return std::nullopt;
}

}  // namespace

ColourBands colourBandsOf(GDALDataset& dataset, BandOrder order, const std::string& name) {
  constexpr int kMostUnnamed = 4;
  const int count = dataset.GetRasterCount();
  if (dataset.GetRasterBand(1)->GetColorInterpretation() == GCI_PaletteIndex) {
    throw InputError(
        fmt::format("{}: has a colour palette; convert it with gdal_translate -expand rgb", name));
  }
  if (count < 3) {
    throw InputError(
        fmt::format("{}: has {} band(s), so no colours; an orthomosaic needs red, green and blue; "
                    "a surface model stands behind its orthomosaic, ORTHO.tif,DSM.tif",
                    name, count));
  }
  if (order == BandOrder::kAuto) {
    if (const auto named = byNames(dataset, name)) return *named;
    if (const auto declared = byDeclaration(dataset)) return *declared;
    if (count > kMostUnnamed) {
      throw InputError(fmt::format(
          "{}: does not say which of its {} bands are red, green and blue; say the order of the "
          "first three, or take them with gdal_translate -b RED -b GREEN -b BLUE",
          name, count));
    }
    order = BandOrder::kRgb;
  }
  static constexpr std::array<std::string_view, 7> kOrders{"rgb", "rgb", "rbg", "grb",
                                                           "gbr", "brg", "bgr"};
  const std::string_view letters = kOrders[static_cast<std::size_t>(order)];
  const auto band = [&](char letter) {
    return dataset.GetRasterBand(static_cast<int>(letters.find(letter)) + 1);
  };
  return {band('r'), band('g'), band('b')};
}

GDALRasterBand* alphaBandOf(GDALDataset& dataset) {
  for (int i = 1; i <= dataset.GetRasterCount(); ++i) {
    GDALRasterBand* const band = dataset.GetRasterBand(i);
    if (band->GetColorInterpretation() != GCI_AlphaBand) continue;
    const std::set<std::string> words = wordsOf(*band);
    if (words.empty() || words.count("alpha") + words.count("mask") > 0) return band;
  }
  return nullptr;
}

std::optional<Raster<std::uint8_t>> maskFromAlpha(const Raster<float>& alpha) {
  constexpr double kMostBetween = 0.1;
  constexpr float kNearly = 0.1F;
  float largest = 0.0F;
  for (const float value : alpha) {
    if (std::isfinite(value)) largest = std::max(largest, value);
  }
  std::size_t between = 0;
  Raster<std::uint8_t> mask(alpha.rows(), alpha.cols(), 0);
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    if (alpha[i] > kNearly * largest && alpha[i] < (1.0F - kNearly) * largest) ++between;
    mask[i] = largest > 0.0F && alpha[i] >= 0.5F * largest ? 1 : 0;
  }
  if (static_cast<double>(between) > kMostBetween * static_cast<double>(alpha.size())) {
    return std::nullopt;
  }
  return mask;
}

double heightUnitOf(GDALDataset& dataset, GDALRasterBand& band, const std::string& name,
                    std::vector<std::string>& warnings) {
  const char* const text = band.GetUnitType();
  const std::string unit = lowerCase(text == nullptr ? "" : text);
  if (!unit.empty()) {
    const auto metres = metresPer(unit);
    if (!metres) {
      throw InputError(fmt::format(
          "{}: its heights are in '{}', a unit that is not known; set what it is with gdal_edit.py "
          "-units m, or bring it to metres with gdal_calc.py",
          name, text));
    }
    return *metres;
  }
  const OGRSpatialReference* const srs = dataset.GetSpatialRef();
  if (srs == nullptr) return 1.0;
  const Crs crs = crsFrom(*srs);
  if (srs->IsVertical() == 0 && std::abs(crs.horizontal_unit - 1.0) > kMetreTolerance) {
    warnings.push_back(fmt::format(
        "{}: it does not say the unit of its heights; taken is that of x and y ({:.10g} m)", name,
        crs.horizontal_unit));
  }
  return crs.vertical_unit;
}

void refusePictureAsHeights(GDALDataset& dataset, const Raster<float>& values,
                            const std::string& name) {
  constexpr int kColours = 3;
  constexpr std::size_t kManyValues = 16;
  if (dataset.GetRasterCount() >= kColours) {
    throw InputError(
        fmt::format("{}: has {} bands: it is a picture, not a surface model, which has one band of "
                    "heights",
                    name, dataset.GetRasterCount()));
  }
  std::set<float> seen;
  const std::size_t step = std::max<std::size_t>(1, values.size() / kSamples);
  for (std::size_t i = 0; i < values.size(); i += step) {
    const float value = values[i];
    if (!std::isfinite(value)) continue;
    // Heights come in parts of a metre.
    if (value != std::floor(value) || value < 0.0F || value > 255.0F) return;
    seen.insert(value);
  }
  if (seen.size() < kManyValues) return;
  throw InputError(
      fmt::format("{}: its values are whole numbers from {} to {}, as of a picture or hillshade, "
                  "not heights in "
                  "metres; take the surface model itself",
                  name, *seen.begin(), *seen.rbegin()));
}

}  // namespace agricolmap::io
