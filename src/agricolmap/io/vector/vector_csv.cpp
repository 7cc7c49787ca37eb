#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string textOf(const VectorValue& value, int decimals) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
  const auto* real = std::get_if<double>(&value);
  if (real == nullptr || !std::isfinite(*real)) return "";
  return fmt::format("{:.{}f}", *real, decimals);
}

}  // namespace

void writeCsv(const OutputPath& path, const VectorLayer& layer) {
  std::string text = layer.kind == GeometryKind::kPoint ? "x,y" : "";
  for (const VectorField& field : layer.fields) {
    if (!text.empty()) text += ',';
    text += quoted(field.name);
  }
  text += '\n';
  for (const VectorFeature& feature : layer.features) {
    std::string line;
    if (layer.kind == GeometryKind::kPoint) {
      line = fmt::format("{:.3f},{:.3f}", feature.points.front().x(), feature.points.front().y());
    }
    for (std::size_t k = 0; k < layer.fields.size(); ++k) {
      if (k > 0 || !line.empty()) line += ',';
      line += textOf(feature.values[k], layer.fields[k].decimals);
    }
    text += line + '\n';
  }
  writeText(path, text);
}

}  // namespace agricolmap::io
