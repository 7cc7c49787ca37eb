#include "agricolmap/batch/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::batch {
namespace {

std::string numberText(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "";
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string safe = "\"";
  for (const char c : text) safe += c == '"' ? std::string("\"\"") : std::string(1, c);
  return safe + '"';
}

/// The first line of a message.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

void Counts::add(const Record& record) {
  ++(record.status == "accepted"    ? accepted
     : record.status == "ambiguous" ? ambiguous
     : record.status == "rejected"  ? rejected
                                    : failed);
}

Counts countsOf(std::span<const Record> records) {
  Counts counts;
  for (const Record& record : records) counts.add(record);
  return counts;
}

std::string toText(const Counts& counts) {
  std::vector<std::string> parts;
  const auto add = [&](std::size_t count, const char* name) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, name));
  };
  add(counts.accepted, "accepted");
  add(counts.rejected, "rejected");
  add(counts.ambiguous, "ambiguous");
  add(counts.failed, "failed");
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string lineOf(const Record& record, std::size_t id_width) {
  std::string line = fmt::format("{:<{}}  {:<9}", record.id, id_width, record.status);
  if (!record.failed()) {
    line += fmt::format("  {:.3f}  {:>6}  {:<8}  {:5.1f} s", record.probability,
                        std::isfinite(record.expected_error)
                            ? fmt::format("{:.1f} cm", 100.0 * record.expected_error)
                            : "-",
                        record.heights, record.seconds);
  }
  if (record.status != "accepted") line += "  " + firstLine(record.message);
  return line;
}

std::string csvOf(std::span<const Record> records) {
  std::string text =
      "id,map,date,status,probability,expected_error_m,heights,height_error_m,seconds,message\n";
  for (const Record& record : records) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", quoted(record.id), quoted(record.map),
                        record.date == 0 ? "" : std::to_string(record.date), record.status,
                        record.failed() ? "" : numberText(record.probability, 4),
                        numberText(record.expected_error, 4), record.heights,
                        numberText(record.height_error, 4), numberText(record.seconds, 2),
                        quoted(record.message));
  }
  return text;
}

nlohmann::ordered_json summaryJson(std::span<const Record> records, const Manifest& manifest,
                                   double seconds) {
  const Counts counts = countsOf(records);
  nlohmann::ordered_json strips = nlohmann::ordered_json::array();
  for (const Record& record : records) strips.push_back(toJson(record));
  return {{"format", "agricolmap-batch-summary"},
          {"format_version", 1},
          {"manifest", report::validUtf8(manifest.file.string())},
          {"seconds", seconds},
          {"counts",
           {{"accepted", counts.accepted},
            {"rejected", counts.rejected},
            {"ambiguous", counts.ambiguous},
            {"failed", counts.failed}}},
          {"strips", std::move(strips)}};
}

std::string jsonOf(std::span<const Record> records, const Manifest& manifest, double seconds) {
  return summaryJson(records, manifest, seconds).dump(2) + "\n";
}

}  // namespace agricolmap::batch
