#include "agricolmap/batch/record.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "agricolmap/config/text.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::batch {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int kVersion = 1;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double numberOf(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Name, relative to the manifest's absolute folder, size and time of change of a file, in a line.
std::string stateOf(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const fs::path name = fs::absolute(file).lexically_normal().lexically_relative(folder);
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return fmt::format("{} -\n", name.string());
  const auto changed = fs::last_write_time(file, error).time_since_epoch().count();
  return fmt::format("{} {} {}\n", name.string(), size, changed);
}

/// A map's files and those beside it that say where it lies.
std::string statesOf(const std::string& map, const fs::path& folder) {
  const io::MapFiles files = io::mapFilesOf(map);
  std::string states = stateOf(files.main, folder);
  if (files.model) states += stateOf(*files.model, folder);
  const fs::path home = files.main.parent_path();
  const std::string stem = files.main.stem().string();
  for (const std::string& beside :
       {stem + ".prj", stem + "_wkt.prj", stem + ".offset.xyz", std::string("offset.xyz")}) {
    states += stateOf(home / beside, folder);
  }
  return states;
}

/// FNV-1a: tells whether something was changed, not who changed it.
std::uint64_t hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3;
  return hash;
}

}  // namespace

Record recordOf(const Strip& strip, const Manifest& manifest) {
  Record record;
  record.id = strip.id;
  record.map = manifest.maps[strip.map].id;
  record.date = strip.date;
  record.status = "failed";
  return record;
}

void setVerdict(const verdict::Verdict& verdict,
                const std::optional<verdict::PoseUncertainty>& uncertainty, Record& record) {
  record.status = verdict::toString(verdict.status);
  record.probability = verdict.plane_probability;
  if (uncertainty) record.expected_error = uncertainty->expected_rms;
  record.heights = verdict::toString(verdict.heights.status);
  record.height_error = verdict.heights.deviation;
  record.message = verdict.reasons.empty() ? "" : verdict.reasons.front();
}

Json toJson(const Record& record) {
  Json outline = Json::array();
  for (const Eigen::Vector2d& corner : record.outline) outline.push_back({corner.x(), corner.y()});
  return {{"id", report::validUtf8(record.id)},
          {"map", report::validUtf8(record.map)},
          {"date", record.date},
          {"status", record.status},
          {"probability", number(record.probability)},
          {"expected_error_m", number(record.expected_error)},
          {"heights", record.heights},
          {"height_error_m", number(record.height_error)},
          {"seconds", number(record.seconds)},
          {"message", report::validUtf8(record.message)},
          {"fingerprint", record.fingerprint},
          {"outline_m", outline}};
}

void writeRecord(const io::OutputPath& path, const Record& record) {
  Json json = {{"format", "agricolmap-batch-item"}, {"format_version", kVersion}};
  json.update(toJson(record));
  io::writeText(path, json.dump(2) + "\n");
}

std::optional<Record> readRecord(const fs::path& folder) {
  std::ifstream stream(folder / kRecordName);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    if (json.at("format") != "agricolmap-batch-item") return std::nullopt;
    Record record;
    record.id = json.at("id");
    record.map = json.at("map");
    record.date = json.at("date");
    record.status = json.at("status");
    record.probability = numberOf(json.at("probability"));
    record.expected_error = numberOf(json.at("expected_error_m"));
    record.heights = json.at("heights");
    record.height_error = numberOf(json.at("height_error_m"));
    record.seconds = numberOf(json.at("seconds"));
    record.message = json.at("message");
    record.fingerprint = json.at("fingerprint");
    for (const Json& corner : json.at("outline_m")) {
      record.outline.emplace_back(numberOf(corner.at(0)), numberOf(corner.at(1)));
    }
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;  // as if it were not there: the strip is done again
  }
}

std::string fingerprintOf(const Strip& strip, const Manifest& manifest) {
  const fs::path folder = fs::absolute(manifest.file).lexically_normal().parent_path();
  const MapEntry& map = manifest.maps[strip.map];
  std::string text = fmt::format("format {}\n", kVersion);
  text += statesOf(map.file, folder) + statesOf(strip.file, folder);
  for (const std::string& file : {strip.prior, strip.path, map.crs, strip.crs}) {
    text += file.empty() ? "-\n" : stateOf(file, folder);
  }
  text += fmt::format("{} {} {}\n", map.id, strip.date, strip.settings.preset);
  text += fmt::format("{} {} {}\n", strip.settings.aligned, strip.settings.keep_rejected,
                      strip.settings.pictures);
  pipeline::RegistrationOptions options = strip.options;
  const OptionTable table = optionTable(options);
  for (const OptionField& field : table.fields()) {
    text += fmt::format("{} {}\n", field.path, config::optionText(field));
  }
  return fmt::format("{:016x}", hashOf(text));
}

}  // namespace agricolmap::batch
