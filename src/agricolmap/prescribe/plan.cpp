#include "agricolmap/prescribe/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::prescribe {
namespace {

constexpr int kLeastSamples = 8;   // along a side of a square
constexpr int kMostSamples = 512;  // the same
constexpr double kFiner = 4.0;     // cells of a task file along a turned square's shorter side

/// A square by its corners in the map's coordinates: south-west, south-east, north-west, north-east
/// of its own directions.
struct Quad {
  Eigen::Vector2d a, b, c, d;

  Eigen::Vector2d at(double u, double v) const {
    return (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
  }
};

/// Half-way points of equal parts: cells smaller than a part are passed over, larger ones count by
/// their share.
float meanOf(const GridFrame& frame, const Raster<float>& values, const Quad& quad,
             double least_seen) {
  const double side = std::max((quad.b - quad.a).norm(), (quad.c - quad.a).norm());
  const int samples =
      std::clamp(static_cast<int>(std::ceil(side / frame.cell)), kLeastSamples, kMostSamples);
  double sum = 0.0;
  int known = 0;
  for (int i = 0; i < samples; ++i) {
    for (int k = 0; k < samples; ++k) {
      const Eigen::Vector2d cell = frame.cellOf(quad.at((k + 0.5) / samples, (i + 0.5) / samples));
      const auto col = static_cast<int>(std::lround(cell.x()));
      const auto row = static_cast<int>(std::lround(cell.y()));
      if (!values.contains(row, col) || !std::isfinite(values(row, col))) continue;
      sum += static_cast<double>(values(row, col));
      ++known;
    }
  }
  return known > 0 && known >= least_seen * samples * samples
             ? static_cast<float>(sum / known)
             : std::numeric_limits<float>::quiet_NaN();
}

double threeDigits(double value) {
  const std::string text = fmt::format("{:.3g}", value);
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

Raster<float> squareMeans(const GridFrame& frame, const Raster<float>& values,
                          const Lattice& lattice, const Earth& earth, double least_seen) {
  const std::vector<Eigen::Vector2d> corners = cornersInFile(lattice, earth);
  const auto stride = static_cast<std::size_t>(lattice.cols) + 1;
  Raster<float> means(lattice.rows, lattice.cols);
  parallelFor(static_cast<std::size_t>(lattice.rows), [&](std::size_t row) {
    for (int col = 0; col < lattice.cols; ++col) {
      const Eigen::Vector2d* low = &corners[row * stride + static_cast<std::size_t>(col)];
      const Eigen::Vector2d* high = low + stride;
      means(static_cast<int>(row), col) =
          meanOf(frame, values, {low[0], low[1], high[0], high[1]}, least_seen);
    }
  });
  return means;
}

bool trim(Lattice& lattice, Raster<float>& means) {
  int row_begin = means.rows();
  int row_end = 0;
  int col_begin = means.cols();
  int col_end = 0;
  for (int row = 0; row < means.rows(); ++row) {
    for (int col = 0; col < means.cols(); ++col) {
      if (!std::isfinite(means(row, col))) continue;
      row_begin = std::min(row_begin, row);
      row_end = std::max(row_end, row + 1);
      col_begin = std::min(col_begin, col);
      col_end = std::max(col_end, col + 1);
    }
  }
  if (row_begin >= row_end) return false;
  Raster<float> inner(row_end - row_begin, col_end - col_begin);
  for (int row = 0; row < inner.rows(); ++row) {
    for (int col = 0; col < inner.cols(); ++col) {
      inner(row, col) = means(row_begin + row, col_begin + col);
    }
  }
  lattice = lattice.part(row_begin, col_begin, inner.rows(), inner.cols());
  means = std::move(inner);
  return true;
}

std::vector<double> quantileBreaks(const Raster<float>& means, int count) {
  std::vector<float> known;
  std::copy_if(means.begin(), means.end(), std::back_inserter(known),
               [](float value) { return std::isfinite(value); });
  std::vector<double> breaks;
  for (int i = 1; i < count; ++i) {
    breaks.push_back(threeDigits(static_cast<double>(quantile(known, 1.0 * i / count))));
  }
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    if (breaks[i] > breaks[i - 1]) continue;
    throw InputError(
        fmt::format("the squares have too few different values for {} classes of as many squares "
                    "each, two of which would part at {:g}; say where classes are to part: breaks",
                    count, breaks[i]));
  }
  return breaks;
}

Plan planOf(Lattice lattice, Raster<float> means, const std::vector<double>& breaks,
            const std::vector<double>& rates, const RateUnit& unit, const Earth& earth) {
  if (rates.size() != breaks.size() + 1) {
    throw UsageError(fmt::format("{} breaks part {} classes, and there are {} rates", breaks.size(),
                                 breaks.size() + 1, rates.size()));
  }
  if (rates.size() > kMostClasses) {
    throw UsageError(fmt::format("{} classes are too many (limit {})", rates.size(), kMostClasses));
  }
  for (std::size_t i = 0; i < breaks.size(); ++i) {
    if (std::isfinite(breaks[i]) && (i == 0 || breaks[i] > breaks[i - 1])) continue;
    throw UsageError(fmt::format("breaks must rise, and {:g} does not", breaks[i]));
  }
  Plan plan;
  plan.lattice = std::move(lattice);
  plan.means = std::move(means);
  plan.unit = unit;
  plan.breaks = breaks;
  plan.code = Raster<std::uint8_t>(plan.means.rows(), plan.means.cols());
  for (const double rate : rates) {
    ClassShare& share = plan.classes.emplace_back();
    share.rate = rate;
    share.task_value = taskValue(rate, unit);
  }
  const std::vector<double> areas = squareAreas(plan.lattice, earth);
  for (int row = 0; row < plan.means.rows(); ++row) {
    for (int col = 0; col < plan.means.cols(); ++col) {
      const float mean = plan.means(row, col);
      if (!std::isfinite(mean)) continue;
      const auto index = static_cast<std::size_t>(
          std::upper_bound(breaks.begin(), breaks.end(), static_cast<double>(mean)) -
          breaks.begin());
      plan.code(row, col) = static_cast<std::uint8_t>(index + 1);
      ++plan.classes[index].squares;
      plan.classes[index].area += areas[static_cast<std::size_t>(row)];
    }
  }
  for (ClassShare& share : plan.classes) {
    share.amount = amountOn(share.area, taskRate(share.task_value, unit), unit);
    plan.area += share.area;
    plan.amount += share.amount;
  }
  return plan;
}

TaskGrid taskGridOf(const Plan& plan, const Earth& earth) {
  if (plan.lattice.in_degrees) return {plan.lattice, plan.code, plan.amount};
  const Lattice& turned = plan.lattice;
  std::vector<Eigen::Vector2d> corners = {turned.at(0, 0), turned.at(0, turned.cols),
                                          turned.at(turned.rows, 0),
                                          turned.at(turned.rows, turned.cols)};
  GridFrame frame;
  frame.corner = corners.front();
  Eigen::Vector2d high = corners.front();
  for (const Eigen::Vector2d& corner : corners) {
    frame.corner = frame.corner.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  frame.cell = std::min(turned.axes.col(0).norm(), turned.axes.col(1).norm()) / kFiner;
  frame.cols = static_cast<int>(std::ceil((high - frame.corner).x() / frame.cell));
  frame.rows = static_cast<int>(std::ceil((high - frame.corner).y() / frame.cell));
  TaskGrid grid;
  grid.lattice = degreeLattice(frame, earth, frame.cell, frame.cell);
  grid.code = Raster<std::uint8_t>(grid.lattice.rows, grid.lattice.cols);
  std::vector<Eigen::Vector2d> middles;
  for (int row = 0; row < grid.lattice.rows; ++row) {
    for (int col = 0; col < grid.lattice.cols; ++col) {
      middles.push_back(grid.lattice.at(row + 0.5, col + 0.5));
    }
  }
  middles = earth.file_from_degrees(middles);
  const std::vector<double> areas = squareAreas(grid.lattice, earth);
  for (std::size_t i = 0; i < middles.size(); ++i) {
    const Eigen::Vector2d place = turned.placeOf(middles[i]);
    const auto col = static_cast<int>(std::floor(place.x()));
    const auto row = static_cast<int>(std::floor(place.y()));
    if (!plan.code.contains(row, col) || plan.code(row, col) == 0) continue;
    grid.code[i] = plan.code(row, col);
    const ClassShare& share = plan.classes[plan.code(row, col) - 1U];
    grid.amount += amountOn(areas[i / static_cast<std::size_t>(grid.lattice.cols)],
                            taskRate(share.task_value, plan.unit), plan.unit);
  }
  return grid;
}

}  // namespace agricolmap::prescribe
