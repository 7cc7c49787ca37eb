#include "agricolmap/crop/row_trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace agricolmap::crop {

namespace {

constexpr double kWindowRows = 2.0;   // length of the piece looked at, in row spacings …
constexpr double kLeastWindow = 1.2;  // … and at least [m]
constexpr double kSoilGreen = 0.25;   // greenness that may be soil's noise
constexpr double kAside = 0.45;       // of the spacing: what lies farther is the next row's
constexpr double kOwn = 0.3;          // of the spacing: a second row does not come nearer
constexpr double kLeastCover = 0.02;  // of the window's middle: something grows

/// Where rows have been found: the coarse cells near their lines.
using Owned = Raster<std::uint8_t>;

class Tracer {
 public:
  Tracer(const CoarseGreen& field, const RowLattice& lattice, const RowOptions& options)
      : field_(field),
        spacing_(lattice.spacing),
        window_(std::max(kLeastWindow, kWindowRows * lattice.spacing)),
        step_(std::max(0.1, 0.2 * window_)),
        options_(options),
        owned_(field.frame.rows, field.frame.cols, 0) {}

  /// The row through a place, unless it was found already or there is none.
  std::optional<RowLine> trace(const RowPlace& seed) {
    const std::optional<RowPlace> start = settled(seed);
    if (!start || owned(start->point)) return std::nullopt;
    std::vector<Eigen::Vector2d> back = follow({start->point, -start->along});
    std::vector<Eigen::Vector2d> points(back.rbegin(), back.rend());
    points.push_back(start->point);
    const std::vector<Eigen::Vector2d> ahead = follow(*start);
    points.insert(points.end(), ahead.begin(), ahead.end());
    if (points.size() < 3) return std::nullopt;
    RowLine line = smoothed(RowLine(std::move(points)));
    if (line.length() < options_.min_length) return std::nullopt;
    own(line);
    return line;
  }

 private:
  struct Seen {
    double aside = 0.0;  ///< middle of what is green, to the left [m]
    double slope = 0.0;  ///< of the row against the direction looked along
    double cover = 0.0;  ///< mean greenness about the line
    double known = 0.0;  ///< share of the window that the map shows
  };

  /// The greenness in a window about a place, its middle counting most across.
  Seen look(const RowPlace& place, double length) const {
    const double step = field_.frame.cell;
    const double reach = kAside * spacing_;
    const int steps = std::max(2, static_cast<int>(0.5 * length / step));
    const int aside = std::max(1, static_cast<int>(reach / step));
    double w = 0.0;
    double wt = 0.0;
    double ws = 0.0;
    double wss = 0.0;
    double wst = 0.0;
    double middle = 0.0;
    int middle_cells = 0;
    int known = 0;
    int all = 0;
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -aside; j <= aside; ++j) {
        const double s = i * step;
        const double t = j * step;
        const Eigen::Vector2d at =
            field_.frame.cellOf(place.point + s * place.along + t * place.left());
        const int col = static_cast<int>(std::lround(at.x()));
        const int row = static_cast<int>(std::lround(at.y()));
        ++all;
        if (!field_.green.contains(row, col)) continue;
        const auto green = static_cast<double>(field_.green(row, col));
        if (!std::isfinite(green)) continue;
        ++known;
        if (std::abs(t) <= 0.2 * spacing_) {
          middle += std::max(0.0, green - kSoilGreen);
          ++middle_cells;
        }
        if (green <= kSoilGreen) continue;
        const double u = std::cos(0.5 * std::numbers::pi * t / (reach + step));
        const double weight = u * u * (green - kSoilGreen);
        w += weight;
        wt += weight * t;
        ws += weight * s;
        wss += weight * s * s;
        wst += weight * s * t;
      }
    }
    Seen seen;
    seen.known = static_cast<double>(known) / all;
    seen.cover = middle_cells > 0 ? middle / middle_cells : 0.0;
    if (w > 0.0) {
      seen.aside = wt / w;
      // About the middle; a faint pull keeps a single plant from turning the row.
      const double spread = wss - ws * ws / w + 0.02 * w * length * length;
      seen.slope = (wst - ws * wt / w) / spread;
    }
    return seen;
  }

  std::optional<RowPlace> settled(RowPlace place) const {
    for (int i = 0; i < 6; ++i) {
      const Seen seen = look(place, 1.5 * window_);
      if (seen.cover < kLeastCover) return std::nullopt;
      place = corrected(place, seen, 1.0);
    }
    return place;
  }

  static RowPlace corrected(const RowPlace& place, const Seen& seen, double gain) {
    const double turn = gain * std::clamp(seen.slope, -0.25, 0.25);
    const Eigen::Vector2d along = (place.along + turn * place.left()).normalized();
    return {place.point + gain * seen.aside * place.left(), along};
  }

  /// Points after `place`, up to the last one where something grows.
  std::vector<Eigen::Vector2d> follow(RowPlace place) const {
    std::vector<Eigen::Vector2d> points;
    std::size_t green = 0;
    double bare = 0.0;
    while (bare < options_.break_length) {
      place.point += step_ * place.along;
      const Seen seen = look(place, window_);
      if (seen.known < 0.2 || owned(place.point)) break;
      if (seen.cover >= kLeastCover) place = corrected(place, seen, 0.5);
      points.push_back(place.point);
      if (look(place, 2.0 * step_).cover >= kLeastCover) {
        green = points.size();
        bare = 0.0;
      } else {
        bare += step_;
      }
    }
    points.resize(green);
    return points;
  }

  /// Each point anew in the middle of what is green about it.
  RowLine smoothed(const RowLine& line) const {
    const int count = std::max(2, static_cast<int>(std::ceil(line.length() / step_)));
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i <= count; ++i) {
      RowPlace place = line.at(line.length() * i / count);
      for (int k = 0; k < 2; ++k) {
        const Seen seen = look(place, window_);
        if (seen.cover >= kLeastCover) place.point += 0.8 * seen.aside * place.left();
      }
      points.push_back(place.point);
    }
    std::vector<Eigen::Vector2d> soft = points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      soft[i] = 0.25 * points[i - 1] + 0.5 * points[i] + 0.25 * points[i + 1];
    }
    return RowLine(std::move(soft));
  }

  bool owned(const Eigen::Vector2d& point) const {
    const Eigen::Vector2d at = field_.frame.cellOf(point);
    const int col = static_cast<int>(std::lround(at.x()));
    const int row = static_cast<int>(std::lround(at.y()));
    return owned_.contains(row, col) && owned_(row, col) != 0;
  }

  void own(const RowLine& line) {
    const double cell = field_.frame.cell;
    const int reach = static_cast<int>(kOwn * spacing_ / cell);
    for (double s = 0.0; s <= line.length(); s += 0.5 * cell) {
      const RowPlace place = line.at(s);
      for (int j = -reach; j <= reach; ++j) {
        const Eigen::Vector2d at = field_.frame.cellOf(place.point + (j * cell) * place.left());
        const int col = static_cast<int>(std::lround(at.x()));
        const int row = static_cast<int>(std::lround(at.y()));
        if (owned_.contains(row, col)) owned_(row, col) = 1;
      }
    }
  }

  const CoarseGreen& field_;
  double spacing_;
  double window_;
  double step_;
  RowOptions options_;
  Owned owned_;
};

}  // namespace

std::vector<RowLine> traceRows(const CoarseGreen& field, const RowLattice& lattice,
                               const RowOptions& options) {
  Tracer tracer(field, lattice, options);
  const Eigen::Vector2d heading(std::cos(lattice.heading), std::sin(lattice.heading));
  std::vector<RowLine> rows;
  for (const RowTile& tile : lattice.tiles) {
    Eigen::Vector2d along(std::cos(tile.heading), std::sin(tile.heading));
    const Eigen::Vector2d left(-along.y(), along.x());
    const int reach = static_cast<int>(std::ceil(0.5 * tile.side / lattice.spacing));
    for (int k = -reach; k <= reach; ++k) {
      const double aside = tile.offset + k * lattice.spacing;
      if (std::abs(aside) > 0.5 * tile.side) continue;
      // A gap in the middle of the tile must not hide a row.
      for (const double ahead : {0.0, -0.3, 0.3}) {
        const Eigen::Vector2d at = tile.centre + aside * left + (ahead * tile.side) * along;
        std::optional<RowLine> row = tracer.trace({at, along});
        if (row) rows.push_back(std::move(*row));
      }
    }
  }
  for (RowLine& row : rows) {
    std::vector<Eigen::Vector2d> points = row.points();
    if ((points.back() - points.front()).dot(heading) >= 0.0) continue;
    std::reverse(points.begin(), points.end());
    row = RowLine(std::move(points));
  }
  const Eigen::Vector2d left(-heading.y(), heading.x());
  std::stable_sort(rows.begin(), rows.end(), [&](const RowLine& a, const RowLine& b) {
    return a.at(0.5 * a.length()).point.dot(left) < b.at(0.5 * b.length()).point.dot(left);
  });
  return rows;
}

}  // namespace agricolmap::crop
