#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/colour_scale.hpp"
#include "agricolmap/io/cloud/hole_height.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {
namespace {

/// Nothing on Earth has larger projected coordinates; beyond are uninitialised values.
constexpr double kMaxCoordinate = 1e8;
/// A first point that is nearer than this to the middle is one of the cloud's [m].
constexpr double kOfTheCloud = 1e3;
/// Points that the middle is taken from, about, and the most chunks that they are looked for in.
constexpr std::size_t kSamples = 1024;
constexpr std::size_t kSampledChunks = 8;  // spread over the file: decoding all would be dear
constexpr std::size_t kEnoughSamples = 100;
/// From here on 32-bit floats are coarser than 0.8 cm.
constexpr double kFarForFloat = 1e5;
constexpr float kNoColour = std::numeric_limits<float>::quiet_NaN();

/// The points of another source, brought into other coordinates.
class MappedSource : public PointSource {
 public:
  MappedSource(const PointSource& source, const CoordinateMap& map) : source_(source), map_(map) {}
  std::size_t points() const override { return source_.points(); }
  std::size_t chunks() const override { return source_.chunks(); }
  std::size_t firstPoint(std::size_t chunk) const override { return source_.firstPoint(chunk); }
  ColourKind colourKind() const override { return source_.colourKind(); }
  bool floatCoordinates() const override { return source_.floatCoordinates(); }
  void decode(std::size_t chunk, const Sink& sink) const override {
    source_.decode(chunk, [&](const PointBlock& block) {
      PointBlock mapped = block;
      map_.apply(mapped.xyz[0].data(), mapped.xyz[1].data(), mapped.xyz[2].data(), block.count);
      sink(mapped);
    });
  }

 private:
  const PointSource& source_;
  const CoordinateMap& map_;
};

bool isWide(ColourKind kind) {
  return kind == ColourKind::kWideInteger || kind == ColourKind::kWideFloat;
}

Eigen::Vector3d pointOf(const PointBlock& block, std::size_t i) {
  return {block.xyz[0][i], block.xyz[1][i], block.xyz[2][i]};
}

/// Written so that NaN fails.
bool within(const Eigen::Vector3d& point, double limit) {
  return std::abs(point.x()) <= limit && std::abs(point.y()) <= limit &&
         std::abs(point.z()) <= limit;
}

/// That says where the cloud is: exporters write (0, 0, 0) for points that they do not have.
bool tellsPlace(const Eigen::Vector3d& point) {
  return within(point, kMaxCoordinate) && !point.isZero(0.0);
}

/// The least and the largest channel of a wide colour; both NaN where it is not finite.
std::pair<float, float> spanOf(const PointBlock& block, std::size_t i) {
  const auto [least, most] = std::minmax({block.wide[0][i], block.wide[1][i], block.wide[2][i]});
  const float sum = block.wide[0][i] + block.wide[1][i] + block.wide[2][i];
  if (!std::isfinite(sum)) return {kNoColour, kNoColour};
  return {least, most};
}

/// A first look at a file.
struct Samples {
  std::vector<Eigen::Vector3d> points;
  ColourTally colours;  ///< of the points that tell a place, where colours are wide

  LowestHeights heights() const {
    LowestHeights lowest;
    for (const Eigen::Vector3d& point : points) lowest.take(point.z());
    return lowest;
  }
};

/// Of every `step`-th chunk, of the points that tell a place every n-th, the first among them, so
/// that there are about kSamples; in file order.
Samples samplePoints(const PointSource& source, std::size_t step) {
  const std::size_t stride = std::max<std::size_t>(1, source.points() / step / kSamples);
  const bool wide = isWide(source.colourKind());
  std::vector<Samples> parts((source.chunks() + step - 1) / step);
  parallelFor(parts.size(), [&](std::size_t part) {
    std::size_t seen = 0;
    source.decode(part * step, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.count; ++i) {
        const Eigen::Vector3d point = pointOf(block, i);
        if (!tellsPlace(point)) continue;
        if (wide) {
          const auto [least, most] = spanOf(block, i);
          if (!std::isnan(least)) parts[part].colours.take(least, most);
        }
        if (seen++ % stride == 0) parts[part].points.push_back(point);
      }
    });
  });
  Samples samples;
  for (const Samples& part : parts) {
    samples.points.insert(samples.points.end(), part.points.begin(), part.points.end());
    samples.colours += part.colours;
  }
  return samples;
}

/// Median of each coordinate.
Eigen::Vector3d medianOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d median;
  std::vector<double> values(points.size());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const Eigen::Vector3d& point) { return point[axis]; });
    std::nth_element(values.begin(), middle, values.end());
    median[axis] = *middle;
  }
  return median;
}

Samples samplesOf(const PointSource& source) {
  const std::size_t step = std::max<std::size_t>(1, source.chunks() / kSampledChunks);
  Samples samples = samplePoints(source, step);
  // Most of the points cannot be used: none is spared a look.
  if (samples.points.size() < kEnoughSamples && step > 1) samples = samplePoints(source, 1);
  return samples;
}

/// The first point, if it is where the others are, else their middle. Zero when all points are
/// there, or none can be used.
Eigen::Vector3d chooseOrigin(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d median = medianOf(points);
  const bool of_the_cloud = within(points.front() - median, kOfTheCloud);
  return (of_the_cloud ? points.front() : median).array().round().matrix();
}

void warnIfCoarse(const PointSource& source, Cloud& cloud) {
  const double far = cloud.origin.cwiseAbs().maxCoeff();
  if (!source.floatCoordinates() || far <= kFarForFloat) return;
  const auto value = static_cast<float>(far);
  const float step = std::nextafter(value, std::numeric_limits<float>::infinity()) - value;
  cloud.warnings.push_back(fmt::format(
      "{}: coordinates around {:.0f} m are stored as 32-bit floats, in steps of {:.1f} cm; write "
      "them as double or subtract an offset (offset.xyz) before writing",
      cloud.name, far, 100.0F * step));
}

Rgb narrow(const PointBlock& block, std::size_t i, float scale) {
  const auto byte = [&](std::size_t c) {
    return static_cast<std::uint8_t>(std::clamp(scale * block.wide[c][i] + 0.5F, 0.0F, 255.0F));
  };
  return {byte(0), byte(1), byte(2)};
}

/// Large arrays are touched for the first time here; huge pages save most of the page faults.
template <typename T>
void resizeInHugePages(std::vector<T>& values, std::size_t size) {
  constexpr std::size_t kHuge = 1U << 21;
  values.reserve(size);
  auto* const first = reinterpret_cast<std::byte*>(values.data());
  const std::size_t skip = (kHuge - reinterpret_cast<std::uintptr_t>(first) % kHuge) % kHuge;
  const std::size_t bytes = size * sizeof(T);
  if (bytes > skip + kHuge) ::madvise(first + skip, (bytes - skip) / kHuge * kHuge, MADV_HUGEPAGE);
  values.resize(size);
}

/// What is made of a file's points, decided by all of them.
struct Reading {
  ColourScale scale;
  std::optional<double> hole;  ///< the height that stands for none

  bool operator==(const Reading& other) const {
    return scale.factor == other.scale.factor && hole == other.hole;
  }
};

/// Points of one chunk, or of all.
struct Tally {
  std::size_t kept = 0;
  std::size_t far = 0;  ///< that tell a place, but one too far from the origin
  std::size_t withheld = 0;
  std::size_t off_colour = 0;  ///< whose wide colours are outside the range of the others
  std::size_t holes = 0;
  ColourTally colours;    ///< of what can be used, where colours are wide
  LowestHeights heights;  ///< of what tells a place

  Tally& operator+=(const Tally& other) {
    kept += other.kept;
    far += other.far;
    withheld += other.withheld;
    off_colour += other.off_colour;
    holes += other.holes;
    heights += other.heights;
    colours += other.colours;
    return *this;
  }
};

/// Closes the gaps that dropped points left at the ends of chunks.
void compact(const PointSource& source, const std::vector<Tally>& tallies, Cloud& cloud) {
  std::size_t next = 0;
  for (std::size_t chunk = 0; chunk < tallies.size(); ++chunk) {
    const std::size_t kept = tallies[chunk].kept;
    if (next == source.firstPoint(chunk)) {
      next += kept;
      continue;
    }
    const auto from = static_cast<std::ptrdiff_t>(source.firstPoint(chunk));
    const auto count = static_cast<std::ptrdiff_t>(kept);
    const auto to = static_cast<std::ptrdiff_t>(next);
    std::copy_n(cloud.xyz.begin() + from, count, cloud.xyz.begin() + to);
    if (cloud.hasColour()) std::copy_n(cloud.rgb.begin() + from, count, cloud.rgb.begin() + to);
    next += kept;
  }
  cloud.dropped_points = cloud.xyz.size() - next;
  cloud.xyz.resize(next);
  if (cloud.hasColour()) cloud.rgb.resize(next);
}

/// Decodes a chunk to where its points belong when none before them is dropped.
Tally decodeChunk(const PointSource& source, std::size_t chunk, const Reading& reading,
                  Cloud& cloud) {
  const ColourKind kind = source.colourKind();
  const bool wide = isWide(kind);
  const std::size_t first = source.firstPoint(chunk);
  Tally tally;
  source.decode(chunk, [&](const PointBlock& block) {
    tally.withheld += block.withheld;
    for (std::size_t i = 0; i < block.count; ++i) {
      const Eigen::Vector3d point = pointOf(block, i);
      const Eigen::Vector3d local = point - cloud.origin;
      if (!within(local, kMaxFromOrigin)) {
        tally.far += tellsPlace(point) ? 1 : 0;
        continue;
      }
      tally.heights.take(point.z());
      if (reading.hole && point.z() == *reading.hole) {
        ++tally.holes;
        continue;
      }
      if (wide) {
        const auto [least, most] = spanOf(block, i);
        if (std::isnan(least)) continue;
        tally.colours.take(least, most);
        if (!reading.scale.holds(least, most)) {
          ++tally.off_colour;
          continue;
        }
      }
      const std::size_t next = first + tally.kept++;
      cloud.xyz[next] = local.cast<float>();
      if (kind == ColourKind::kByte) {
        cloud.rgb[next] = block.rgb[i];
      } else if (kind != ColourKind::kNone) {
        cloud.rgb[next] = narrow(block, i, reading.scale.factor);
      }
    }
  });
  return tally;
}

std::vector<Tally> decodeAll(const PointSource& source, const Reading& reading, Cloud& cloud) {
  std::vector<Tally> tallies(source.chunks());
  parallelFor(source.chunks(), [&](std::size_t chunk) {
    tallies[chunk] = decodeChunk(source, chunk, reading, cloud);
  });
  return tallies;
}

Tally sumOf(const std::vector<Tally>& tallies) {
  return std::accumulate(tallies.begin(), tallies.end(), Tally{},
                         [](Tally sum, const Tally& part) { return sum += part; });
}

void checkDropped(const PointSource& source, const Tally& tally, Cloud& cloud) {
  if (tally.far > cloud.size()) {
    throw InputError(fmt::format(
        "{}: {} of its {} points lie more than {:.0f} km from its middle, too far for a field; "
        "check the units (coordinates must be metres)",
        cloud.name, tally.far, source.points(), kMaxFromOrigin / 1000.0));
  }
  if (cloud.empty()) {
    throw InputError(
        tally.withheld > 0
            ? fmt::format("{}: {} of its {} points are marked as withheld, and none "
                          "of the others is finite",
                          cloud.name, tally.withheld, source.points())
            : fmt::format("{}: none of its {} points is finite", cloud.name, source.points()));
  }
  if (tally.withheld > 0) {
    cloud.warnings.push_back(
        fmt::format("{}: {} points were left out: marked as withheld", cloud.name, tally.withheld));
  }
  if (tally.off_colour > 0) {
    cloud.warnings.push_back(fmt::format(
        "{}: {} points were left out: colours outside the range that those of the others are in",
        cloud.name, tally.off_colour));
  }
  if (tally.holes > 0) {
    cloud.warnings.push_back(fmt::format(
        "{}: {} points were left out: all at the height {}, far below the others, as holes are "
        "written",
        cloud.name, tally.holes, tally.heights.lowest));
  }
  const std::size_t unusable =
      cloud.dropped_points - tally.withheld - tally.off_colour - tally.holes;
  if (unusable == 0) return;
  cloud.warnings.push_back(fmt::format(
      "{}: {} points were left out: NaN, infinite or more than {:.0f} km from the others",
      cloud.name, unusable, kMaxFromOrigin / 1000.0));
}

/// By what was seen of the points; nothing where their colours fit no range.
std::optional<Reading> readingOf(ColourKind kind, const ColourTally& colours,
                                 const LowestHeights& heights, const Samples& samples) {
  const auto scale = isWide(kind) ? colours.scale(kind) : ColourScale{};
  if (!scale) return std::nullopt;
  std::vector<double> sampled;
  for (const Eigen::Vector3d& point : samples.points) sampled.push_back(point.z());
  return Reading{*scale, holeHeight(heights, std::move(sampled))};
}

}  // namespace

Cloud assembleCloud(const PointSource& source, const std::string& name, const CoordinateMap* map) {
  if (map != nullptr) return assembleCloud(MappedSource(source, *map), name);
  Cloud cloud;
  cloud.name = name;
  const Samples samples = samplesOf(source);
  cloud.origin = chooseOrigin(samples.points);
  warnIfCoarse(source, cloud);
  const ColourKind kind = source.colourKind();
  resizeInHugePages(cloud.xyz, source.points());
  if (kind != ColourKind::kNone) resizeInHugePages(cloud.rgb, source.points());
  // All points must be seen to know, but the samples tell nearly always what will come of it: a
  // second pass is dear where points are compressed.
  Reading reading =
      readingOf(kind, samples.colours, samples.heights(), samples).value_or(Reading{});
  std::vector<Tally> tallies = decodeAll(source, reading, cloud);
  Tally sum = sumOf(tallies);
  const auto better = readingOf(kind, sum.colours, sum.heights, samples);
  if (!better) {
    throw InputError(
        fmt::format("{}: its colours go from {} to {}; known are 0..1 (float), 0..255 and 0..65535",
                    name, sum.colours.low, sum.colours.high));
  }
  if (!(*better == reading)) {
    reading = *better;
    tallies = decodeAll(source, reading, cloud);
    sum = sumOf(tallies);
  }
  compact(source, tallies, cloud);
  checkDropped(source, sum, cloud);
  return cloud;
}

void warnOfRest(std::size_t count, std::string_view unit, Cloud& cloud) {
  if (count == 0) return;
  cloud.warnings.push_back(
      fmt::format("{}: {} {} after the last point, ignored", cloud.name, count, unit));
}

}  // namespace agricolmap::io
