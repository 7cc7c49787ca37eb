#include "agricolmap/report/json/shared_map_file.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "agricolmap/config/json.hpp"
#include "agricolmap/report/json/json_reader.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kName = "map.json";
constexpr const char* kFormat = "agricolmap-map";

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Vector>
Json vectorJson(const Vector& vector) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) json.push_back(number(vector(i)));
  return json;
}

Json crsJson(const Crs& crs) {
  if (crs.wkt.empty()) return nullptr;
  return {{"name", crs.name}, {"wkt", crs.wkt}};
}

Json sourceJson(const MapSource& source, std::uint16_t code) {
  return {{"code", code},
          {"id", source.id},
          {"file", source.file},
          {"date", source.date == 0 ? Json(nullptr) : Json(source.date)},
          {"points", source.points},
          {"points_in_cloud", source.kept}};
}

Json stripJson(const MapSource& source, const fuse::FusedStrip& strip) {
  Json json = sourceJson(source, strip.code);
  json["run"] = source.run;
  json["status"] = source.status;
  json["heights_limited"] = source.heights_limited;
  json["plane_error_m"] = number(source.errors.plane);
  json["height_error_m"] = number(source.errors.height);
  json["moved_m"] = vectorJson(strip.moved);
  json["seen_m2"] = number(strip.seen_area);
  json["owned_m2"] = number(strip.owned_area);
  json["colour_gain"] = strip.tone.gain;
  json["flat"] = strip.flat;
  return json;
}

Json curveJson(const fuse::HeightCurve& curve) {
  return {{"height_m", curve.height}, {"shift_m", curve.shift}, {"deviation_m", curve.deviation}};
}

Json biasJson(const fuse::SharedMap& map) {
  if (!map.bias) return nullptr;
  return {{"cells", map.bias->cells},
          {"between_strips_m", number(map.bias->between_strips)},
          {"soil", curveJson(map.bias->curves[0])},
          {"plants", curveJson(map.bias->curves[1])},
          {"plants_without_ground", curveJson(map.bias->curves[2])}};
}

Json overlapsJson(const fuse::SharedMap& map) {
  Json all = Json::array();
  for (const fuse::Disagreement& pair : map.overlaps) {
    all.push_back({{"strips", {map.strips[pair.first].id, map.strips[pair.second].id}},
                   {"area_m2", number(pair.area)},
                   {"offset_m", vectorJson(pair.offset)},
                   {"correlation", number(pair.correlation)},
                   {"sigmas", number(pair.sigmas)},
                   {"plausible", pair.plausible()}});
  }
  return all;
}

Json frameJson(const fuse::SharedMap& map) {
  const GridFrame& frame = map.layers.frame;
  return {{"origin_m", vectorJson(map.layers.origin)},
          {"corner_m", vectorJson(frame.corner)},
          {"cell_m", frame.cell},
          {"fine_cell_m", frame.cell / map.lattice.factor},
          {"rows", frame.rows},
          {"cols", frame.cols}};
}

MapSource sourceIn(const JsonReader& json) {
  MapSource source;
  source.id = json.at("id").text();
  source.file = json.at("file").text();
  source.points = static_cast<std::uint64_t>(json.at("points").number());
  if (!json.at("date").isNull()) source.date = json.at("date").integer();
  return source;
}

StripShare shareIn(const JsonReader& json) {
  StripShare share;
  share.code = static_cast<std::uint16_t>(json.at("code").integer());
  // What no reader needs, who else writes such a file may leave out.
  if (json.has("moved_m")) share.moved = json.at("moved_m").vector<3>();
  if (json.has("seen_m2")) share.seen_area = json.at("seen_m2").numberOr(0.0);
  if (json.has("owned_m2")) share.owned_area = json.at("owned_m2").numberOr(0.0);
  return share;
}

}  // namespace

std::string sharedMapJson(const fuse::SharedMap& map, const MapFacts& facts,
                          const fuse::FuseOptions& options) {
  Json json;
  json["format"] = kFormat;
  json["format_version"] = 1;
  json["crs"] = crsJson(facts.crs);
  json["flat"] = map.flat;
  json["frame"] = frameJson(map);
  json["sources"] = Json::array({sourceJson(facts.fixed, fuse::kFixedSource)});
  for (std::size_t i = 0; i < facts.strips.size(); ++i) {
    json["sources"].push_back(stripJson(facts.strips[i], map.strips[i]));
  }
  json["overlaps"] = overlapsJson(map);
  json["height_bias"] = biasJson(map);
  json["cloud"] = facts.cloud.empty() ? Json(nullptr) : Json(facts.cloud);
  json["layers"] = facts.layers;
  json["warnings"] = map.warnings;
  fuse::FuseOptions copy = options;
  json["options"] = Json::parse(config::toJson(optionTable(copy)).dump());
  json["command_line"] = facts.command_line;
  json["version"] = facts.version;
  return json.dump(2) + "\n";
}

std::optional<std::filesystem::path> StoredMap::layer(const std::string& name) const {
  std::filesystem::path path = folder / "layers" / (name + ".tif");
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  return path;
}

bool StoredMap::hasFixedOf(const StoredMap& other) const {
  return fixed.file == other.fixed.file && fixed.date == other.fixed.date &&
         fixed.points == other.fixed.points;
}

bool isSharedMap(const std::filesystem::path& folder) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(folder / kName, ignored);
}

StoredMap readSharedMap(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kName;
  if (!isSharedMap(folder)) {
    throw InputError(
        fmt::format("{}: there is no {} in it, so it is no shared map; agricolmap fuse makes one",
                    folder.string(), kName));
  }
  const nlohmann::json json =
      readDocument(path, {kFormat, "shared map", "make the map anew with agricolmap fuse"});
  const JsonReader reader(json, path.string());
  StoredMap stored;
  stored.folder = folder;
  stored.flat = reader.at("flat").flag();
  if (const JsonReader crs = reader.at("crs"); !crs.isNull()) {
    stored.crs.name = crs.at("name").text();
    stored.crs.wkt = crs.at("wkt").text();
  }
  const std::vector<JsonReader> sources = reader.at("sources").items();
  if (sources.empty()) reader.at("sources").fail("has no fixed cloud");
  stored.fixed = sourceIn(sources.front());
  for (std::size_t i = 1; i < sources.size(); ++i) {
    const JsonReader& source = sources[i];
    MapSource strip = sourceIn(source);
    strip.run = source.at("run").text();
    strip.status = source.at("status").text();
    strip.heights_limited = source.at("heights_limited").flag();
    strip.errors.plane = source.at("plane_error_m").number();
    strip.errors.height = source.at("height_error_m").number();
    stored.strips.push_back(std::move(strip));
    stored.shares.push_back(shareIn(source));
  }
  if (reader.has("warnings")) {
    for (const JsonReader& line : reader.at("warnings").items()) {
      stored.warnings.push_back(line.text());
    }
  }
  return stored;
}

}  // namespace agricolmap::report
