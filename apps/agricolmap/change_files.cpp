#include "change_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/report/pictures/change_picture.hpp"
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

ordered_json toJson(const LayerChange& layer, const char* kind, const char* unit) {
  const auto key = [&](const char* when) { return fmt::format("{}_{}{}", kind, when, unit); };
  return {{"cells", layer.cells},
          {key("before"), layer.before},
          {key("after"), layer.after},
          {key("change"), layer.after - layer.before}};
}

void writePage(const io::OutputPath& path, const MapChange& found, const ChangeRun& run) {
  const report::LayerTimes none;
  const report::ChangeGround ground{found.ground.frame,
                                    found.ground.origin.head<2>(),
                                    found.heights,
                                    found.surface,
                                    found.plant_height ? found.plant_height->times : none,
                                    found.cover ? found.cover->times : none,
                                    found.colour_before,
                                    found.colour_after};
  const auto pageOf = [&](const std::string& map) {
    return wayTo(std::filesystem::path(map) / "map.html", run.folder);
  };
  ordered_json scene = report::changeScene(ground);
  if (run.pictures) report::addChangePictures(scene, ground);
  io::writeText(path,
                report::changePage(toJson(found), std::move(scene),
                                   {describe(found), run.warnings, pageOf(found.name_a),
                                    pageOf(found.name_b), run.command_line, AGRICOLMAP_VERSION}));
}

void writeBands(const io::OutputPath& path, const MapChange& found,
                const std::vector<io::GeoBand>& bands) {
  io::GeoLayer layer;
  layer.frame = found.ground.frame;
  layer.origin = found.ground.origin;
  layer.crs = found.ground.crs;
  layer.bands = bands;
  layer.nodata = std::numeric_limits<double>::quiet_NaN();
  layer.metadata = {{"AGRICOLMAP_BEFORE", found.name_a}, {"AGRICOLMAP_AFTER", found.name_b}};
  io::writeLayer(path, layer);
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
      {"frame_error", {{"height_m", found.frames.height}, {"plane_m", found.frames.plane}}},
      {"surface",
       {{"median_detection_m", found.totals.median_detection},
        {"compared", toJson(found.totals.compared)},
        {"rise", toJson(found.totals.rise)},
        {"fall", toJson(found.totals.fall)}}}};
  if (found.totals.stable) json["surface"]["bare_ground"] = toJson(*found.totals.stable);
  if (found.plant_height) json["plant_height"] = toJson(*found.plant_height, "median", "_m");
  if (found.cover) json["cover"] = toJson(*found.cover, "mean", "");
  return json;
}

std::vector<report::ChangeFact> describe(const MapChange& found) {
  const change::Totals& totals = found.totals;
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
  if (found.plant_height && found.plant_height->cells > 0) {
    lines.push_back({"plants", fmt::format("{} high before, {} after (median)",
                                           centimetres(found.plant_height->before),
                                           centimetres(found.plant_height->after))});
  }
  if (found.cover) {
    lines.push_back(
        {"cover", fmt::format("{:.1f} % before, {:.1f} % after", 100.0 * found.cover->before,
                              100.0 * found.cover->after)});
  }
  return lines;
}

void writeChange(const io::OutputPath& dir, const MapChange& found, const ChangeRun& run) {
  writeBands(dir / "height_change.tif", found,
             {{&found.heights.change, "change", "m"},
              {&found.heights.detection, "level of detection", "m"},
              {&found.heights.significant, "significant", ""}});
  if (found.plant_height) {
    writeBands(dir / "plant_height_change.tif", found,
               {{&found.plant_height->change, "change", "m"}});
  }
  if (found.cover) {
    writeBands(dir / "cover_change.tif", found, {{&found.cover->change, "change", ""}});
  }
  io::writeText(dir / "change.json", toJson(found).dump(2) + "\n");
  writePage(dir / "change.html", found, run);
  if (!run.pictures) return;
  std::vector<std::string> facts;
  for (const report::ChangeFact& line : describe(found)) {
    facts.push_back(fmt::format("{}: {}", line.label, line.text));
  }
  report::writeChangePicture(
      dir / "change.png",
      {found.heights, found.ground.frame,
       fmt::format("{} (before) and {} (after)", found.name_a, found.name_b), facts});
}

}  // namespace agricolmap
