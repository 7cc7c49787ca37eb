#include "agricolmap/map/grid_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"

namespace agricolmap::map {

void listOptions(OptionTable& table, GridOptions& options) {
  table.number("cell", options.cell, 0.005, 1.0, "m", "side of a grid cell, s in the paper")
      .basic();
  table
      .number("sigma", options.sigma, 0.0001, 10.0, "m",
              "deviation of the Gaussian weight around a cell's centre, sigma_avg in the paper")
      .basic();
  table
      .choice("exg", options.exg, {"plain", "chromatic"},
              "Excess Green on raw colours (the paper's) or on chromatic coordinates")
      .basic();
  table
      .flag("coarsen", options.coarsen,
            "larger cells, and sigma with them, where a cloud has fewer points than cells")
      .basic();
}

float excessGreen(Rgb colour, ExgKind kind) {
  const int sum = colour.r + colour.g + colour.b;
  const int excess = 3 * colour.g - sum;
  if (kind == ExgKind::kPlain) return static_cast<float>(excess) / 255.0F;
  return sum == 0 ? 0.0F : static_cast<float>(excess) / static_cast<float>(sum);
}

namespace {

/// Rows that are summed together: few, so that the points of a batch, which mostly lie close
/// together, are in many of them.
constexpr int kBandRows = 4;
constexpr std::size_t kChunk = 1U << 14;
/// What the rasters of a GridMap take.
constexpr double kCellBytes = 3 * sizeof(float) + sizeof(Rgb);
constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
/// Most memory one map may take: 11 ha in cells of 2 cm. The stages after it take more.
constexpr double kMostMapBytes = 4.0 * kGiB;
/// Farther from a cell's centre than 11 deviations all points weigh alike: sums of such weights are
/// still normal floats, and their quotients are numbers.
constexpr float kLeastExponent = -60.0F;

GridFrame frameFor(const Box2& window, double cell) {
  GridFrame frame;
  frame.cell = cell;
  const Eigen::Array2d low = (window.min().array() / cell).floor();
  const Eigen::Array2d high = (window.max().array() / cell).ceil().max(low + 1.0);
  const Eigen::Array2d count = high - low;
  const double bytes = kCellBytes * count.prod();
  if (!(bytes <= kMostMapBytes)) {
    throw InputError(fmt::format(
        "a map of {:.0f} x {:.0f} m in cells of {:.3g} m takes {:.3g} GiB of memory (limit {:.3g} "
        "GiB); crop the clouds, tighten the prior or enlarge grid.cell to {:.2g} m",
        window.sizes().x(), window.sizes().y(), cell, bytes / kGiB, kMostMapBytes / kGiB,
        // A little more, as borders are rounded to cells and the number to two digits.
        1.1 * cell * std::sqrt(bytes / kMostMapBytes)));
  }
  frame.corner = (low * cell).matrix();
  frame.cols = static_cast<int>(count.x());
  frame.rows = static_cast<int>(count.y());
  return frame;
}

/// A point inside the map, levelled: what the accumulation needs, small enough to sort.
struct Located {
  float u;  ///< continuous column, cell 0 spans [0, 1)
  float v;  ///< continuous row
  float z;
  std::uint32_t index;  ///< in the batch
};

/// Continuous cell of a levelled point; false outside the map.
class Locator {
 public:
  Locator(const GridFrame& frame, const Eigen::Affine3d& levelled_from_local)
      : rows_(static_cast<float>(frame.rows)), cols_(static_cast<float>(frame.cols)) {
    Eigen::Matrix<double, 3, 4> m = levelled_from_local.matrix().topRows<3>();
    m.topRows<2>() /= frame.cell;
    m.col(3).head<2>() -= frame.corner / frame.cell;
    linear_ = m.leftCols<3>().cast<float>();
    shift_ = m.col(3).cast<float>();
  }
  bool locate(const Eigen::Vector3f& p, Located& out) const {
    const Eigen::Vector3f q(along(0, p), along(1, p), along(2, p));
    if (!(q.x() >= 0.0F && q.y() >= 0.0F && q.x() < cols_ && q.y() < rows_)) return false;
    out.u = q.x();
    out.v = q.y();
    out.z = q.z();
    return true;
  }

 private:
  /// Fused by hand: compilers choose one of several ways, and not the same at every place.
  float along(int axis, const Eigen::Vector3f& p) const {
    return std::fma(linear_(axis, 0), p.x(),
                    std::fma(linear_(axis, 1), p.y(), linear_(axis, 2) * p.z())) +
           shift_[axis];
  }

  float rows_;
  float cols_;
  Eigen::Matrix3f linear_;
  Eigen::Vector3f shift_;
};

/// The points of a batch in the window, grouped by bands of rows and in order inside a band, so
/// that bands can be summed in parallel with the same result on any number of threads. Keeps its
/// memory from one batch to the next.
class Bands {
 public:
  Bands(const GridFrame& frame, const Eigen::Affine3d& levelled_from_local)
      : locator_(frame, levelled_from_local),
        bands_(static_cast<std::size_t>((frame.rows + kBandRows - 1) / kBandRows)),
        begin_(bands_ + 1) {}

  void sort(const PointBatch& batch) {
    const std::size_t chunks = (batch.size() + kChunk - 1) / kChunk;
    if (inside_.size() < chunks) inside_.resize(chunks);
    places_.assign(chunks * bands_, 0);
    // Every point is located once: two computations of the same cell need not round alike.
    parallelFor(chunks, [&](std::size_t chunk) { locate(batch, chunk); });
    // Prefix sums give every chunk its own places in every band.
    std::size_t next = 0;
    for (std::size_t band = 0; band < bands_; ++band) {
      begin_[band] = next;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        next += std::exchange(places_[chunk * bands_ + band], next);
      }
    }
    begin_[bands_] = next;
    if (points_.size() < next) points_.resize(next);
    parallelFor(chunks, [&](std::size_t chunk) {
      for (const Located& p : inside_[chunk]) points_[places_[chunk * bands_ + bandOf(p)]++] = p;
    });
  }
  std::size_t count() const { return bands_; }
  std::size_t points() const { return begin_[bands_]; }
  std::span<const Located> band(std::size_t band) const {
    return std::span(points_).subspan(begin_[band], begin_[band + 1] - begin_[band]);
  }

 private:
  static std::size_t bandOf(const Located& p) { return static_cast<std::size_t>(p.v) / kBandRows; }
  void locate(const PointBatch& batch, std::size_t chunk) {
    Located located{};
    inside_[chunk].clear();
    const std::size_t end = std::min(batch.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      if (!locator_.locate(batch.xyz[i], located)) continue;
      located.index = static_cast<std::uint32_t>(i);
      inside_[chunk].push_back(located);
      ++places_[chunk * bands_ + bandOf(located)];
    }
  }

  Locator locator_;
  std::size_t bands_;
  std::vector<std::vector<Located>> inside_;  ///< per chunk
  std::vector<std::size_t> places_;           ///< per chunk and band
  std::vector<Located> points_;
  std::vector<std::size_t> begin_;  ///< per band, plus the end
};

/// Weighted sums of one cell.
struct CellSum {
  float points = 0.0F;  ///< exact up to 16 million
  float weight = 0.0F;
  float height = 0.0F;
  float exg = 0.0F;
  std::array<float, 3> colour{};
};

/// A map on its way. Every cell adds its points in their order, whatever the batches are.
class Gridder {
 public:
  Gridder(const GridFrame& frame, const Eigen::Affine3d& levelled_from_local,
          const GridOptions& options)
      : frame_(frame),
        options_(options),
        bands_(frame, levelled_from_local),
        sums_(bands_.count()) {}

  void add(const PointBatch& batch) {
    bands_.sort(batch);
    points_ += bands_.points();
    parallelFor(bands_.count(), [&](std::size_t band) {
      const std::span<const Located> points = bands_.band(band);
      if (points.empty()) return;
      if (sums_[band].empty()) {
        sums_[band].resize(static_cast<std::size_t>(kBandRows) * frame_.cols);
      }
      accumulate(points, batch.rgb, static_cast<int>(band) * kBandRows, sums_[band]);
    });
  }

  GridMap finish() && {
    GridMap map;
    map.frame = frame_;
    map.points = points_;
    map.weight = Raster<float>(frame_.rows, frame_.cols);
    map.height = Raster<float>(frame_.rows, frame_.cols);
    map.exg = Raster<float>(frame_.rows, frame_.cols);
    map.colour = Raster<Rgb>(frame_.rows, frame_.cols);
    parallelFor(bands_.count(), [&](std::size_t band) {
      writeBand(std::exchange(sums_[band], {}), static_cast<int>(band) * kBandRows, map);
    });
    map.filled = static_cast<std::size_t>(
        std::count_if(map.weight.begin(), map.weight.end(), [](float w) { return w > 0.0F; }));
    return map;
  }

 private:
  void accumulate(std::span<const Located> points, std::span<const Rgb> colours, int first_row,
                  std::vector<CellSum>& sums) const {
    const float cells2_to_exponent = static_cast<float>(-0.5 * options_.cell * options_.cell /
                                                        (options_.sigma * options_.sigma));
    for (const Located& p : points) {
      const int col = static_cast<int>(p.u);
      const int row = static_cast<int>(p.v);
      const float du = p.u - static_cast<float>(col) - 0.5F;
      const float dv = p.v - static_cast<float>(row) - 0.5F;
      const float distance2 = du * du + dv * dv;
      const float weight = std::exp(std::max(kLeastExponent, cells2_to_exponent * distance2));
      CellSum& sum = sums[static_cast<std::size_t>(row - first_row) * frame_.cols + col];
      sum.points += 1.0F;
      sum.weight += weight;
      sum.height += weight * p.z;
      if (!colours.empty()) {
        const Rgb colour = colours[p.index];
        sum.exg += weight * excessGreen(colour, options_.exg);
        sum.colour[0] += weight * colour.r;
        sum.colour[1] += weight * colour.g;
        sum.colour[2] += weight * colour.b;
      }
    }
  }

  static void writeBand(const std::vector<CellSum>& sums, int first_row, GridMap& map) {
    for (std::size_t cell = 0; cell < sums.size(); ++cell) {
      const CellSum& sum = sums[cell];
      if (sum.points <= 0.0F) continue;
      const std::size_t i = map.weight.index(first_row, 0) + cell;
      const float scale = 1.0F / sum.weight;
      map.weight[i] = sum.points;
      map.height[i] = scale * sum.height;
      map.exg[i] = scale * sum.exg;
      map.colour[i] = {static_cast<std::uint8_t>(scale * sum.colour[0] + 0.5F),
                       static_cast<std::uint8_t>(scale * sum.colour[1] + 0.5F),
                       static_cast<std::uint8_t>(scale * sum.colour[2] + 0.5F)};
    }
  }

  GridFrame frame_;
  GridOptions options_;
  Bands bands_;
  std::vector<std::vector<CellSum>> sums_;  ///< of the bands that have points
  std::size_t points_ = 0;
};

}  // namespace

GridMap makeGridMap(const PointStream& cloud, const Eigen::Affine3d& levelled_from_local,
                    const Box2& window, const GridOptions& options) {
  GridMap map;
  // Of boxes that lie apart nothing is left in common.
  if (!window.isEmpty()) {
    Gridder gridder(frameFor(window, options.cell), levelled_from_local, options);
    cloud.passNear(levelled_from_local, window,
                   [&](const PointBatch& batch) { gridder.add(batch); });
    map = std::move(gridder).finish();
  }
  if (map.points == 0) {
    throw InputError(
        fmt::format(
            "{}: no point lies in the window that the initial guess gives; do both clouds use the "
            "same coordinate system?",
            cloud.facts().name),
        Remedy::kInitialGuess);
  }
  return map;
}

GridMap makeGridMap(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local,
                    const Box2& window, const GridOptions& options) {
  return makeGridMap(CloudStream(cloud), levelled_from_local, window, options);
}

GridOptions coarsened(const GridOptions& options, double spacing) {
  // 0.7: half of the cells filled, so that neighbours can be compared.
  const double factor = std::max(1.0, 0.7 * spacing / options.cell);
  GridOptions coarser = options;
  if (!options.coarsen) return coarser;
  coarser.cell *= factor;
  coarser.sigma *= factor;
  return coarser;
}

double canopyHeight(const GridMap& map) {
  std::vector<float> heights;
  heights.reserve(map.filled);
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (map.valid(i)) heights.push_back(map.height[i]);
  }
  if (heights.empty()) return 0.0;
  return std::max(0.0, static_cast<double>(quantile(std::move(heights), 0.9)));
}

bool hasRelief(const GridMap& map) {
  constexpr float kRounding = 2e-3F;  // [m]
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (!map.valid(i)) continue;
    low = std::min(low, map.height[i]);
    high = std::max(high, map.height[i]);
  }
  return high - low > kRounding;
}

GridMap croppedMap(const GridMap& map, const Box2& window) {
  const Eigen::Vector2d low = map.frame.cellOf(window.min());
  const Eigen::Vector2d high = map.frame.cellOf(window.max());
  const auto within = [](double at, int count) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count)));
  };
  const int row0 = within(std::floor(low.y()), map.frame.rows);
  const int col0 = within(std::floor(low.x()), map.frame.cols);
  GridMap part;
  part.frame = map.frame;
  part.frame.corner += map.frame.cell * Eigen::Vector2d(col0, row0);
  part.frame.rows = std::max(0, within(std::ceil(high.y()) + 1.0, map.frame.rows) - row0);
  part.frame.cols = std::max(0, within(std::ceil(high.x()) + 1.0, map.frame.cols) - col0);
  const auto cut = [&]<typename T>(const Raster<T>& from, Raster<T>& to) {
    if (from.empty()) return;
    to = Raster<T>(part.frame.rows, part.frame.cols);
    for (int r = 0; r < part.frame.rows; ++r) {
      std::copy_n(from.row(row0 + r) + col0, part.frame.cols, to.row(r));
    }
  };
  cut(map.weight, part.weight);
  cut(map.height, part.height);
  cut(map.exg, part.exg);
  cut(map.colour, part.colour);
  part.points = map.points;
  part.soil_below = map.soil_below;
  part.filled = static_cast<std::size_t>(
      std::count_if(part.weight.begin(), part.weight.end(), [](float w) { return w > 0.0F; }));
  return part;
}

}  // namespace agricolmap::map
