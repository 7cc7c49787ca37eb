#include "change_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/change/distribution.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/report/gis/layer_styles.hpp"
#include "agricolmap/report/pictures/change_picture.hpp"
#include "change_zones.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

using nlohmann::ordered_json;

ordered_json toJson(const change::Share& share) {
  const double half = change::kLevel95 * share.deviation;
  return {{"cells", share.cells},
          {"area_m2", share.area},
          {"volume_m3", share.volume},
          {"volume_interval_m3", {share.volume - half, share.volume + half}},
          {"mean_m", share.mean()},
          {"mean_deviation_m", share.meanDeviation()},
          {"median_m", share.median}};
}

ordered_json toJson(const change::LayerChange& layer, const char* kind, const char* unit) {
  const auto key = [&](const char* when) { return fmt::format("{}_{}{}", kind, when, unit); };
  return {{"cells", layer.cells},
          {key("before"), layer.before},
          {key("after"), layer.after},
          {key("change"), layer.after - layer.before}};
}

ordered_json surfaceJson(const change::Totals& totals) {
  ordered_json json = {{"median_detection_m", totals.median_detection},
                       {"compared", toJson(totals.compared)},
                       {"rise", toJson(totals.rise)},
                       {"fall", toJson(totals.fall)}};
  if (totals.stable) json["bare_ground"] = toJson(*totals.stable);
  return json;
}

void writePage(const io::OutputPath& path, const MapChange& found, const ChangeRun& run) {
  const change::LayerTimes none;
  const report::ChangeGround ground{
      found.ground.frame,
      found.ground.origin.head<2>(),
      found.compared.heights,
      found.surface,
      found.compared.plant_height ? found.compared.plant_height->times : none,
      found.compared.cover ? found.compared.cover->times : none,
      found.colour_before,
      found.colour_after};
  const auto pageOf = [&](const std::string& map) {
    return wayTo(std::filesystem::path(map) / "map.html", run.folder);
  };
  ordered_json scene = report::changeScene(ground, found.zones);
  if (run.pictures) report::addChangePictures(scene, ground);
  io::writeText(path,
                report::changePage(toJson(found), std::move(scene),
                                   {describe(found), run.warnings, pageOf(found.name_a),
                                    pageOf(found.name_b), run.command_line, AGRICOLMAP_VERSION}));
}

/// The first of the bands is the change; `reach`: what its colours reach to.
void writeBands(const io::OutputPath& dir, const std::string& name, const MapChange& found,
                const std::vector<io::GeoBand>& bands, double reach) {
  io::GeoLayer layer;
  layer.frame = found.ground.frame;
  layer.origin = found.ground.origin;
  layer.crs = found.ground.crs;
  layer.bands = bands;
  layer.nodata = std::numeric_limits<double>::quiet_NaN();
  layer.metadata = {{"AGRICOLMAP_BEFORE", found.name_a}, {"AGRICOLMAP_AFTER", found.name_b}};
  io::writeLayer(dir / (name + ".tif"), layer);
  report::writeChangeStyle(dir, name, reach, bands.front().unit);
}

/// Without the sign of what is rounded to nothing.
std::string rounded(double value, int digits) {
  const double unit = std::pow(10.0, digits);
  return fmt::format("{:.{}f}", std::round(value * unit) / unit + 0.0, digits);
}

/// "12.3 m2, 1.20 m3 (0.80 to 1.60)"; of little, more digits.
std::string describe(const change::Share& share) {
  const double half = change::kLevel95 * share.deviation;
  const int digits = std::abs(share.volume) + half < 0.1 ? 4 : 2;
  return fmt::format("{} m2, {} m3 ({} to {})", rounded(share.area, share.area < 1.0 ? 3 : 1),
                     rounded(share.volume, digits), rounded(share.volume - half, digits),
                     rounded(share.volume + half, digits));
}

}  // namespace

ordered_json toJson(const MapChange& found) {
  const GridFrame& frame = found.ground.frame;
  const Eigen::Vector2d corner = found.ground.origin.head<2>() + frame.corner;
  ordered_json json = {
      {"format", "agricolmap-change"},
      {"format_version", 1},
      {"before", found.name_a},
      {"after", found.name_b},
      {"grid",
       {{"south_west", {corner.x(), corner.y()}},
        {"cell_m", frame.cell},
        {"rows", frame.rows},
        {"cols", frame.cols},
        {"crs", found.ground.crs}}},
      {"frame_error",
       {{"height_m", found.compared.frames.height}, {"plane_m", found.compared.frames.plane}}}};
  json["surface"] =
      found.compared.flat ? ordered_json(nullptr) : surfaceJson(found.compared.totals);
  if (found.compared.plant_height)
    json["plant_height"] = toJson(*found.compared.plant_height, "median", "_m");
  if (found.compared.cover) json["cover"] = toJson(*found.compared.cover, "mean", "");
  return json;
}

namespace {

std::vector<report::ChangeFact> describe(const change::Totals& totals) {
  const auto centimetres = [](double metres) { return rounded(100.0 * metres, 1) + " cm"; };
  const auto average = [&](const change::Share& share) {
    return fmt::format("by {} +- {} on average", rounded(100.0 * share.mean(), 1),
                       centimetres(change::kLevel95 * share.meanDeviation()));
  };
  const auto significant = [&](const change::Share& share) {
    if (share.cells == 0) return std::string("nowhere by more than its errors");
    return fmt::format("{}, by {} (median)", describe(share), centimetres(share.median));
  };
  std::vector<report::ChangeFact> lines = {
      {"compared", fmt::format("{}, {}", describe(totals.compared), average(totals.compared))},
      {"rose", significant(totals.rise)},
      {"fell", significant(totals.fall)},
      {"level", fmt::format("{} (median): what a cell's change must exceed",
                            centimetres(totals.median_detection))}};
  if (totals.stable && totals.stable->cells > 0) {
    lines.push_back({"bare ground",
                     fmt::format("{:.1f} m2, {}", totals.stable->area, average(*totals.stable))});
  }
  return lines;
}

/// The cover's change in place of a surface's; no level is known of it.
change::HeightChange coverChange(const MapChange& found) {
  const Raster<float>& change = found.compared.cover->change;
  return {change, Raster<float>(change.rows(), change.cols()),
          Raster<float>(change.rows(), change.cols(), 1.0F)};
}

void writeHeights(const io::OutputPath& dir, const MapChange& found) {
  writeBands(dir, "height_change", found,
             {{&found.compared.heights.change, "change", "m"},
              {&found.compared.heights.detection, "level of detection", "m"},
              {&found.compared.heights.significant, "significant", ""}},
             change::reachOf(found.compared.heights.change));
}

}  // namespace

std::vector<report::ChangeFact> describe(const MapChange& found) {
  const auto centimetres = [](double metres) { return rounded(100.0 * metres, 1) + " cm"; };
  std::vector<report::ChangeFact> lines;
  if (!found.compared.flat) lines = describe(found.compared.totals);
  if (found.compared.plant_height && found.compared.plant_height->cells > 0) {
    lines.push_back({"plants", fmt::format("{} high before, {} after (median)",
                                           centimetres(found.compared.plant_height->before),
                                           centimetres(found.compared.plant_height->after))});
  }
  if (found.compared.cover) {
    lines.push_back({"cover", fmt::format("{:.1f} % before, {:.1f} % after",
                                          100.0 * found.compared.cover->before,
                                          100.0 * found.compared.cover->after)});
  }
  return lines;
}

void writeChange(const io::OutputPath& dir, const MapChange& found, const ChangeRun& run) {
  if (!found.compared.flat) writeHeights(dir, found);
  if (found.compared.plant_height) {
    const Raster<float>& heights = found.compared.plant_height->change;
    writeBands(dir, "plant_height_change", found, {{&heights, "change", "m"}},
               change::reachOf(heights));
  }
  if (found.compared.cover) {
    writeBands(dir, "cover_change", found, {{&found.compared.cover->change, "change", ""}}, 1.0);
  }
  io::writeText(dir / "change.json", toJson(found).dump(2) + "\n");
  writeZones(dir, found.zones, found.ground.crs);
  writePage(dir / "change.html", found, run);
  if (!run.pictures) return;
  std::vector<std::string> facts;
  for (const report::ChangeFact& line : describe(found)) {
    facts.push_back(fmt::format("{}: {}", line.label, line.text));
  }
  const change::HeightChange drawn =
      found.compared.flat ? coverChange(found) : found.compared.heights;
  report::writeChangePicture(
      dir / "change.png",
      {drawn, found.ground.frame,
       fmt::format("{} (before) and {} (after)", found.name_a, found.name_b), facts,
       found.compared.flat ? "change of the cover [%]" : "change of the surface [cm]",
       !found.compared.flat});
}

}  // namespace agricolmap
