#include "agricolmap/report/page/packed_layer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;
using io::FieldKind;
using io::VectorLayer;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kFinestPlace = 0.001;  // [m]
constexpr double kBend = 0.01;          // of lines that is not worth a point [m]

/// The last code of as many bytes stands for nothing.
double mostCodes(int bytes) { return std::pow(2.0, 8.0 * bytes) - 2.0; }

/// How numbers from `low` on become codes.
struct Steps {
  double low = 0.0;
  double step = 1.0;
  int bytes = 1;
};

/// `exact`: in steps of `finest` whatever it takes; else coarser ones where two bytes do not do.
Steps stepsOf(const std::vector<double>& values, double finest, bool exact) {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {};
  Steps steps{std::floor(low / finest) * finest, finest, 1};
  if (!exact) steps.step = std::max(finest, (high - steps.low) / mostCodes(2));
  const double codes = (high - steps.low) / steps.step;
  if (codes > mostCodes(1)) steps.bytes = codes > mostCodes(2) + 0.5 ? 4 : 2;
  return steps;
}

/// NaN stands for nothing.
Json packedNumbers(const std::vector<double>& values, double finest, bool exact) {
  const Steps steps = stepsOf(values, finest, exact);
  const auto width = static_cast<std::size_t>(steps.bytes);
  std::vector<std::uint8_t> bytes(width * values.size(), 255);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const auto code = static_cast<std::uint32_t>(
        std::clamp(std::round((values[i] - steps.low) / steps.step), 0.0, mostCodes(steps.bytes)));
    for (std::size_t k = 0; k < width; ++k) {
      bytes[width * i + k] = static_cast<std::uint8_t>((code >> (8 * k)) & 255U);
    }
  }
  return {
      {"low", steps.low}, {"step", steps.step}, {"bytes", steps.bytes}, {"data", base64(bytes)}};
}

double numberOf(const io::VectorValue& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return kNone;
}

/// Which of the layer's things are kept, in their order.
std::vector<std::size_t> keptOf(const VectorLayer& layer, const Thinning& thinning) {
  const std::size_t all = layer.features.size();
  std::vector<std::size_t> kept(std::min(all, thinning.most));
  if (kept.size() == all) {
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const auto field = std::ranges::find(layer.fields, thinning.largest, &io::VectorField::name);
  if (field == layer.fields.end()) {
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = i * all / kept.size();
    return kept;
  }
  const auto column = static_cast<std::size_t>(field - layer.fields.begin());
  std::vector<std::size_t> order(all);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return numberOf(layer.features[a].values[column]) > numberOf(layer.features[b].values[column]);
  });
  std::copy_n(order.begin(), kept.size(), kept.begin());
  std::ranges::sort(kept);
  return kept;
}

/// How far a point lies from the piece of line from a to b.
double distance(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - a - share * along).norm();
}

/// Without the points that lie within kBend of the line between those before and behind (Douglas
/// and Peucker 1973).
std::vector<Eigen::Vector2d> straightened(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 3) return points;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> pieces = {{0, points.size() - 1}};
  while (!pieces.empty()) {
    const auto [from, to] = pieces.back();
    pieces.pop_back();
    double most = kBend;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double away = distance(points[i], points[from], points[to]);
      if (away <= most) continue;
      most = away;
      at = i;
    }
    if (at == from) continue;
    kept[at] = true;
    pieces.emplace_back(from, at);
    pieces.emplace_back(at, to);
  }
  std::vector<Eigen::Vector2d> left;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept[i]) left.push_back(points[i]);
  }
  return left;
}

Json packedShapes(const VectorLayer& layer, const std::vector<std::size_t>& kept,
                  const Eigen::Vector2d& origin) {
  std::vector<double> x, y, counts;
  for (const std::size_t i : kept) {
    const std::vector<Eigen::Vector2d>& all = layer.features[i].points;
    const auto points = layer.kind == io::GeometryKind::kLine ? straightened(all) : all;
    counts.push_back(static_cast<double>(points.size()));
    for (const Eigen::Vector2d& point : points) {
      x.push_back(point.x() - origin.x());
      y.push_back(point.y() - origin.y());
    }
  }
  Json json = {{"x", packedNumbers(x, kFinestPlace, false)},
               {"y", packedNumbers(y, kFinestPlace, false)}};
  if (layer.kind != io::GeometryKind::kPoint) json["points"] = packedNumbers(counts, 1.0, true);
  return json;
}

Json packedColumn(const VectorLayer& layer, const std::vector<std::size_t>& kept,
                  std::size_t column) {
  const io::VectorField& field = layer.fields[column];
  if (field.kind == FieldKind::kText) {
    Json texts = Json::array();
    for (const std::size_t i : kept) {
      const auto* text = std::get_if<std::string>(&layer.features[i].values[column]);
      texts.push_back(text != nullptr ? Json(*text) : Json(nullptr));
    }
    return texts;
  }
  std::vector<double> values;
  for (const std::size_t i : kept) {
    values.push_back(numberOf(layer.features[i].values[column]));
  }
  const bool whole = field.kind == FieldKind::kInteger;
  return packedNumbers(values, whole ? 1.0 : std::pow(10.0, -field.decimals), whole);
}

const char* kindName(io::GeometryKind kind) {
  switch (kind) {
    case io::GeometryKind::kPoint:
      return "point";
    case io::GeometryKind::kLine:
      return "line";
    case io::GeometryKind::kPolygon:
      break;
  }
  return "polygon";
}

}  // namespace

Json packedLayer(const io::VectorLayer& layer, const Eigen::Vector2d& origin,
                 const Thinning& thinning) {
  const std::vector<std::size_t> kept = keptOf(layer, thinning);
  Json json = {{"kind", kindName(layer.kind)},
               {"count", kept.size()},
               {"of", layer.features.size()},
               {"shapes", packedShapes(layer, kept, origin)}};
  json["columns"] = Json::object();
  for (std::size_t i = 0; i < layer.fields.size(); ++i) {
    json["columns"][layer.fields[i].name] = packedColumn(layer, kept, i);
  }
  return json;
}

}  // namespace agricolmap::report
