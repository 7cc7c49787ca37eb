#include "agricolmap/report/gis/qgis_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "agricolmap/core/xml_text.hpp"
#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {
namespace {

/// QGIS reads the styles of older versions; this one knows all that is said here.
constexpr const char* kBegin =
    "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
    "<qgis version=\"3.22\" styleCategories=\"Symbology\">\n";

std::string hex(std::uint32_t colour) { return fmt::format("#{:06x}", colour); }

std::string withAlpha(std::uint32_t colour, int alpha) {
  return fmt::format("{},{},{},{}", colour >> 16U, (colour >> 8U) & 255U, colour & 255U, alpha);
}

std::string rasterStyle(const std::string& renderer) {
  return fmt::format("{}<pipe>\n{}</pipe>\n</qgis>\n", kBegin, renderer);
}

enum class Shape { kPoint, kLine, kPolygon };

struct Mark {
  const char* layer;
  Shape shape;
  std::uint32_t colour;
  int alpha;     ///< of 255
  double width;  ///< of lines [mm]
};
constexpr std::array kMarks{Mark{"grid", Shape::kPolygon, 0x455a64, 160, 0.15},
                            Mark{"plots", Shape::kPolygon, 0x101418, 255, 0.4},
                            Mark{"rows", Shape::kLine, 0x90a4ae, 200, 0.2},
                            Mark{"uncountable", Shape::kLine, 0xf9a825, 255, 0.7},
                            Mark{"gaps", Shape::kLine, 0xe53935, 255, 0.7},
                            Mark{"weeds", Shape::kPoint, 0xd81bdc, 255, 0.2},
                            Mark{"plants", Shape::kPoint, 0x1b5e20, 255, 0.15}};

using Properties = std::vector<std::pair<const char*, std::string>>;

/// Points are a decimetre wide, but are seen from afar and hide nothing near.
Properties propertiesOf(const Mark& mark) {
  const std::string colour = withAlpha(mark.colour, mark.alpha);
  const std::string width = fmt::format("{}", mark.width);
  switch (mark.shape) {
    case Shape::kPoint:
      return {{"name", std::string_view(mark.layer) == "weeds" ? "diamond" : "circle"},
              {"color", colour},
              {"outline_color", withAlpha(0xffffff, 255)},
              {"outline_style", "solid"},
              {"outline_width", width},
              {"size", "0.1"},
              {"size_unit", "MapUnit"},
              {"size_map_unit_scale", "3x:0,0,1,0.6,1,2"}};
    case Shape::kLine:
      return {{"line_color", colour},
              {"line_style", "solid"},
              {"line_width", width},
              {"capstyle", "flat"}};
    case Shape::kPolygon:
      return {{"style", "no"},
              {"outline_color", colour},
              {"outline_style", "solid"},
              {"outline_width", width}};
  }
  return {};
}

std::string symbolOf(std::size_t number, Shape shape, const Properties& properties) {
  constexpr std::array<std::pair<const char*, const char*>, 3> kSymbols{
      {{"marker", "SimpleMarker"}, {"line", "SimpleLine"}, {"fill", "SimpleFill"}}};
  const auto& [symbol, drawn_by] = kSymbols[static_cast<std::size_t>(shape)];
  std::string options;
  for (const auto& [name, value] : properties) {
    options += fmt::format("<Option type=\"QString\" name=\"{}\" value=\"{}\"/>\n", name, value);
  }
  return fmt::format(
      "<symbol type=\"{}\" name=\"{}\" alpha=\"1\">\n<layer class=\"{}\" enabled=\"1\">\n"
      "<Option type=\"Map\">\n{}</Option>\n</layer>\n</symbol>\n",
      symbol, number, drawn_by, options);
}

std::string markStyle(const Mark& mark) {
  return fmt::format(
      "{}<renderer-v2 type=\"singleSymbol\">\n<symbols>\n{}</symbols>\n</renderer-v2>\n</qgis>\n",
      kBegin, symbolOf(0, mark.shape, propertiesOf(mark)));
}

/// What is drawn where an expression holds.
struct Rule {
  std::string where;
  std::string label;
  Properties fill;
};

std::string rulesStyle(const std::vector<Rule>& rules) {
  std::string listed, symbols;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    listed += fmt::format("<rule key=\"{0}\" symbol=\"{0}\" filter=\"{1}\" label=\"{2}\"/>\n", i,
                          xmlText(rules[i].where), xmlText(rules[i].label));
    symbols += symbolOf(i, Shape::kPolygon, rules[i].fill);
  }
  return fmt::format(
      "{}<renderer-v2 type=\"RuleRenderer\" symbollevels=\"0\">\n<rules key=\"root\">\n{}</rules>\n"
      "<symbols>\n{}</symbols>\n</renderer-v2>\n</qgis>\n",
      kBegin, listed, symbols);
}

/// Half transparent, so that the map below is seen; the outline tells parts apart on any ground.
Properties filled(std::uint32_t colour) {
  return {{"style", "solid"},
          {"color", withAlpha(colour, 200)},
          {"outline_color", withAlpha(0x101418, 255)},
          {"outline_style", "solid"},
          {"outline_width", "0.2"}};
}

}  // namespace

std::string qgisRamp(const RampStyle& style) {
  const std::string unit = style.unit.empty() ? "" : fmt::format(" {}", xmlText(style.unit));
  std::string items;
  for (std::size_t i = 0; i < style.stops.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(style.stops.size() - 1);
    const double value = style.low + share * (style.high - style.low);
    items += fmt::format("<item value=\"{}\" color=\"{}\" alpha=\"255\" label=\"{:.5g}{}\"/>\n",
                         value, hex(style.stops[i]), value, unit);
  }
  return rasterStyle(fmt::format(
      "<rasterrenderer type=\"singlebandpseudocolor\" band=\"{0}\" opacity=\"1\" alphaBand=\"-1\" "
      "classificationMin=\"{1}\" classificationMax=\"{2}\">\n<rastershader>\n"
      "<colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" clip=\"0\" "
      "minimumValue=\"{1}\" maximumValue=\"{2}\">\n{3}"
      "</colorrampshader>\n</rastershader>\n</rasterrenderer>\n",
      style.band, style.low, style.high, items));
}

std::string qgisCodes(const std::vector<CodeStyle>& codes) {
  std::string entries;
  for (const CodeStyle& code : codes) {
    entries += fmt::format("<paletteEntry value=\"{}\" color=\"{}\" alpha=\"255\" label=\"{}\"/>\n",
                           code.code, hex(code.colour), xmlText(code.label));
  }
  return rasterStyle(
      fmt::format("<rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\">\n"
                  "<colorPalette>\n{}</colorPalette>\n</rasterrenderer>\n",
                  entries));
}

std::string qgisChange(const ChangeShades& shades) {
  constexpr int kClasses = 6;
  constexpr std::uint32_t kUnsure = 0xb0b4ba;
  const std::string value = "(" + shades.change + ")";
  const std::string known = value + " IS NOT NULL";
  std::string sure;
  std::vector<Rule> rules;
  if (!shades.sure.empty()) {
    sure = fmt::format(" AND ({}) = 1", shades.sure);
    rules.push_back({fmt::format("{} AND ({}) = 0", known, shades.sure), "no more than errors",
                     filled(kUnsure)});
  }
  const auto label = [&](double change) {
    return fmt::format("{:+.{}f}", shades.factor * change, shades.digits);
  };
  for (int i = 0; i < kClasses; ++i) {
    const double low = shades.reach * (2.0 * i / kClasses - 1.0);
    const double high = low + 2.0 * shades.reach / kClasses;
    std::string where = known + sure;
    if (i > 0) where += fmt::format(" AND {} >= {:.9g}", value, low);
    if (i + 1 < kClasses) where += fmt::format(" AND {} < {:.9g}", value, high);
    rules.push_back({where, fmt::format("{} to {} {}", label(low), label(high), shades.unit),
                     filled(rampColour(kFallToRise, (i + 0.5) / kClasses))});
  }
  const auto* const plots = std::ranges::find(kMarks, std::string_view("plots"), &Mark::layer);
  rules.push_back({value + " IS NULL", "not compared", propertiesOf(*plots)});
  return rulesStyle(rules);
}

std::string qgisMarks(std::string_view layer) {
  const auto* const mark = std::ranges::find(kMarks, layer, &Mark::layer);
  return mark == kMarks.end() ? "" : markStyle(*mark);
}

}  // namespace agricolmap::report
