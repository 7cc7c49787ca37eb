#include "agricolmap/io/cloud/point_taking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/plain_block.hpp"

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

/// Nothing where no coordinate is lost.
std::optional<std::string> coarseness(const PointFile& file, const Eigen::Vector3d& origin) {
  const double far = origin.cwiseAbs().maxCoeff();
  if (!file.source->floatCoordinates() || far <= kFarForFloat) return std::nullopt;
  const auto value = static_cast<float>(far);
  const float step = std::nextafter(value, std::numeric_limits<float>::infinity()) - value;
  return fmt::format(
      "{}: coordinates around {:.0f} m are stored as 32-bit floats, in steps of {:.1f} cm; write "
      "them as double or subtract an offset (offset.xyz) before writing",
      file.name, far, 100.0F * step);
}

Rgb narrow(const PointBlock& block, std::size_t i, float factor) {
  return {narrowed(block.wide[0][i], factor), narrowed(block.wide[1][i], factor),
          narrowed(block.wide[2][i], factor)};
}

/// Takes those points of a block that are kept, one after the other.
void takeEach(const PointBlock& block, ColourKind kind, bool marked, const Taking& taking,
              Tally& tally, TakenPoints& taken) {
  taken.count = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    const Eigen::Vector3d point = pointOf(block, i);
    const Eigen::Vector3d local = point - taking.origin;
    if (!within(local, kMaxFromOrigin)) {
      tally.far += tellsPlace(point) ? 1 : 0;
      continue;
    }
    tally.heights.take(point.z());
    if (taking.hole && point.z() == *taking.hole) {
      ++tally.holes;
      continue;
    }
    if (isWide(kind)) {
      const auto [least, most] = spanOf(block, i);
      if (std::isnan(least)) continue;
      tally.colours.take(least, most);
      if (!taking.colours.holds(least, most)) {
        ++tally.off_colour;
        continue;
      }
    }
    const std::size_t next = taken.count++;
    taken.xyz[next] = local.cast<float>();
    if (kind == ColourKind::kByte) {
      taken.rgb[next] = block.rgb[i];
    } else if (kind != ColourKind::kNone) {
      taken.rgb[next] = narrow(block, i, taking.colours.factor);
    }
    if (marked) taken.marks[next] = block.marks[i];
  }
}

/// What was left out, in words; throws where too much was.
std::vector<std::string> leftOut(const PointFile& file, const Tally& sum) {
  const std::size_t points = file.source->points();
  if (sum.far > sum.kept) {
    throw InputError(fmt::format(
        "{}: {} of its {} points lie more than {:.0f} km from its middle, too far for a field; "
        "check the units (coordinates must be metres)",
        file.name, sum.far, points, kMaxFromOrigin / 1000.0));
  }
  if (sum.kept == 0) {
    throw InputError(sum.withheld > 0
                         ? fmt::format("{}: {} of its {} points are marked as withheld, and none "
                                       "of the others is finite",
                                       file.name, sum.withheld, points)
                         : fmt::format("{}: none of its {} points is finite", file.name, points));
  }
  std::vector<std::string> words;
  if (sum.withheld > 0) {
    words.push_back(
        fmt::format("{}: {} points were left out: marked as withheld", file.name, sum.withheld));
  }
  if (sum.off_colour > 0) {
    words.push_back(fmt::format(
        "{}: {} points were left out: colours outside the range that those of the others are in",
        file.name, sum.off_colour));
  }
  if (sum.holes > 0) {
    words.push_back(fmt::format(
        "{}: {} points were left out: all at the height {}, far below the others, as holes are "
        "written",
        file.name, sum.holes, sum.heights.lowest));
  }
  const std::size_t unusable = points - sum.kept - sum.withheld - sum.off_colour - sum.holes;
  if (unusable > 0) {
    words.push_back(fmt::format(
        "{}: {} points were left out: NaN, infinite or more than {:.0f} km from the others",
        file.name, unusable, kMaxFromOrigin / 1000.0));
  }
  return words;
}

/// Nothing where the colours fit no range.
std::optional<ColourScale> scaleOf(ColourKind kind, const ColourTally& colours) {
  return isWide(kind) ? colours.scale(kind) : ColourScale{};
}

}  // namespace

FirstLook firstLook(const PointSource& source) {
  const Samples samples = samplesOf(source);
  FirstLook look;
  look.taking.origin = chooseOrigin(samples.points);
  LowestHeights lowest;
  for (const Eigen::Vector3d& point : samples.points) {
    lowest.take(point.z());
    look.heights.push_back(point.z());
  }
  // All points must be seen to know, but the samples tell nearly always what will come of it: a
  // second pass is dear where points are compressed.
  if (const auto scale = scaleOf(source.colourKind(), samples.colours)) {
    look.taking.colours = *scale;
    look.taking.hole = holeHeight(lowest, look.heights);
  }
  return look;
}

Tally& Tally::operator+=(const Tally& other) {
  kept += other.kept;
  far += other.far;
  withheld += other.withheld;
  off_colour += other.off_colour;
  holes += other.holes;
  colours += other.colours;
  heights += other.heights;
  return *this;
}

Tally sumOf(const std::vector<Tally>& tallies) {
  return std::accumulate(tallies.begin(), tallies.end(), Tally{},
                         [](Tally sum, const Tally& part) { return sum += part; });
}

Tally takeChunk(const PointSource& source, std::size_t chunk, const Taking& taking,
                const std::function<void(const TakenPoints&)>& sink) {
  const ColourKind kind = source.colourKind();
  const bool marked = source.marked();
  Tally tally;
  TakenPoints taken;
  source.decode(chunk, [&](const PointBlock& block) {
    tally.withheld += block.withheld;
    if (takePlainBlock(block, kind, taking, tally, taken)) {
      if (marked) std::copy_n(block.marks.begin(), block.count, taken.marks.begin());
    } else {
      takeEach(block, kind, marked, taking, tally, taken);
    }
    tally.kept += taken.count;
    sink(taken);
  });
  return tally;
}

Taking finalTaking(const PointFile& file, const FirstLook& first, const Tally& sum) {
  if (const auto scale = scaleOf(file.source->colourKind(), sum.colours)) {
    return {first.taking.origin, *scale, holeHeight(sum.heights, first.heights)};
  }
  throw InputError(
      fmt::format("{}: its colours go from {} to {}; known are 0..1 (float), 0..255 and 0..65535",
                  file.name, sum.colours.low, sum.colours.high));
}

bool isColoured(const PointFile& file, const Tally& sum) {
  return file.source->colourKind() != ColourKind::kNone &&
         !(file.black_is_none && sum.colours.high <= 0.0F);
}

std::vector<std::string> warningsOf(const PointFile& file, const Taking& taking, const Tally& sum) {
  std::vector<std::string> warnings = file.warnings;
  if (const auto coarse = coarseness(file, taking.origin)) warnings.push_back(*coarse);
  for (std::string& words : leftOut(file, sum)) warnings.push_back(std::move(words));
  if (file.source->colourKind() != ColourKind::kNone && !isColoured(file, sum)) {
    warnings.push_back(fmt::format("{}: all its colours are black; taken as none", file.name));
  }
  warnings.insert(warnings.end(), file.notes.begin(), file.notes.end());
  return warnings;
}

}  // namespace agricolmap::io
