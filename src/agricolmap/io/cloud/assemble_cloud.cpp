#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {
namespace {

/// Nothing on Earth has larger projected coordinates; beyond are uninitialised values.
constexpr double kMaxCoordinate = 1e8;
/// From here on 32-bit floats are coarser than 0.8 cm.
constexpr double kFarForFloat = 1e5;
/// From here on local floats are coarser than 1 mm.
constexpr float kFarForLocal = 16384.0F;

bool isWide(ColourKind kind) {
  return kind == ColourKind::kWideInteger || kind == ColourKind::kWideFloat;
}

bool usable(const PointBlock& block, std::size_t i) {
  // Written so that NaN fails.
  return std::abs(block.xyz[0][i]) <= kMaxCoordinate &&
         std::abs(block.xyz[1][i]) <= kMaxCoordinate && std::abs(block.xyz[2][i]) <= kMaxCoordinate;
}

bool usableColour(const PointBlock& block, std::size_t i) {
  return std::isfinite(block.wide[0][i]) && std::isfinite(block.wide[1][i]) &&
         std::isfinite(block.wide[2][i]);
}

Eigen::Vector3d chooseOrigin(const PointSource& source, const std::string& name) {
  bool found = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (std::size_t chunk = 0; chunk < source.chunks() && !found; ++chunk) {
    throwIfInterrupted();
    source.decode(chunk, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.count && !found; ++i) {
        if (!usable(block, i)) continue;
        origin = {std::round(block.xyz[0][i]), std::round(block.xyz[1][i]),
                  std::round(block.xyz[2][i])};
        found = true;
      }
    });
  }
  if (!found) {
    throw InputError(
        fmt::format("{}: none of its {} points has finite coordinates", name, source.points()));
  }
  return origin;
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

struct ColourRange {
  float low = 0.0F;
  float high = 0.0F;
};

ColourRange colourRange(const PointSource& source) {
  std::vector<ColourRange> parts(source.chunks());
  parallelFor(source.chunks(), [&](std::size_t chunk) {
    ColourRange& range = parts[chunk];
    source.decode(chunk, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.count; ++i) {
        if (!usable(block, i) || !usableColour(block, i)) continue;
        for (const auto& channel : block.wide) {
          range.low = std::min(range.low, channel[i]);
          range.high = std::max(range.high, channel[i]);
        }
      }
    });
  });
  ColourRange range;
  for (const ColourRange& part : parts) {
    range.low = std::min(range.low, part.low);
    range.high = std::max(range.high, part.high);
  }
  return range;
}

/// What wide colours are multiplied by to be 0–255.
float colourScale(const PointSource& source, const std::string& name) {
  const ColourRange range = colourRange(source);
  if (range.low >= 0.0F) {
    if (source.colourKind() == ColourKind::kWideFloat && range.high <= 1.0F) return 255.0F;
    if (range.high <= 255.0F) return 1.0F;
    if (range.high <= 65535.0F) return 1.0F / 257.0F;
  }
  throw InputError(
      fmt::format("{}: its colours go from {} to {}; known are 0..1 (float), 0..255 and 0..65535",
                  name, range.low, range.high));
}

Rgb narrow(const PointBlock& block, std::size_t i, float scale) {
  const auto byte = [&](std::size_t c) {
    return static_cast<std::uint8_t>(std::min(255.0F, scale * block.wide[c][i] + 0.5F));
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

/// Closes the gaps that dropped points left at the ends of chunks.
void compact(const PointSource& source, const std::vector<std::size_t>& kept, Cloud& cloud) {
  std::size_t next = 0;
  for (std::size_t chunk = 0; chunk < kept.size(); ++chunk) {
    if (next == source.firstPoint(chunk)) {
      next += kept[chunk];
      continue;
    }
    const auto from = static_cast<std::ptrdiff_t>(source.firstPoint(chunk));
    const auto count = static_cast<std::ptrdiff_t>(kept[chunk]);
    const auto to = static_cast<std::ptrdiff_t>(next);
    std::copy_n(cloud.xyz.begin() + from, count, cloud.xyz.begin() + to);
    if (cloud.hasColour()) std::copy_n(cloud.rgb.begin() + from, count, cloud.rgb.begin() + to);
    next += kept[chunk];
  }
  cloud.dropped_points = cloud.xyz.size() - next;
  cloud.xyz.resize(next);
  if (cloud.hasColour()) cloud.rgb.resize(next);
}

}  // namespace

Cloud assembleCloud(const PointSource& source, const std::string& name) {
  Cloud cloud;
  cloud.name = name;
  cloud.origin = chooseOrigin(source, name);
  warnIfCoarse(source, cloud);
  const ColourKind kind = source.colourKind();
  const float scale = isWide(kind) ? colourScale(source, name) : 1.0F;
  resizeInHugePages(cloud.xyz, source.points());
  if (kind != ColourKind::kNone) resizeInHugePages(cloud.rgb, source.points());
  std::vector<std::size_t> kept(source.chunks(), 0);
  std::vector<float> farthest(source.chunks(), 0.0F);
  parallelFor(source.chunks(), [&](std::size_t chunk) {
    std::size_t next = source.firstPoint(chunk);
    float far = 0.0F;
    source.decode(chunk, [&](const PointBlock& block) {
      for (std::size_t i = 0; i < block.count; ++i) {
        if (!usable(block, i) || (isWide(kind) && !usableColour(block, i))) continue;
        const Eigen::Vector3d point(block.xyz[0][i], block.xyz[1][i], block.xyz[2][i]);
        const Eigen::Vector3f local = (point - cloud.origin).cast<float>();
        far = std::max(far, local.cwiseAbs().maxCoeff());
        cloud.xyz[next] = local;
        if (kind == ColourKind::kByte) {
          cloud.rgb[next] = block.rgb[i];
        } else if (kind != ColourKind::kNone) {
          cloud.rgb[next] = narrow(block, i, scale);
        }
        ++next;
      }
    });
    kept[chunk] = next - source.firstPoint(chunk);
    farthest[chunk] = far;
  });
  compact(source, kept, cloud);
  if (cloud.empty()) throw InputError(fmt::format("{}: no usable point is left", name));
  if (cloud.dropped_points > 0) {
    cloud.warnings.push_back(
        fmt::format("{}: {} points with NaN, infinite or absurd coordinates were left out", name,
                    cloud.dropped_points));
  }
  const float far = *std::max_element(farthest.begin(), farthest.end());
  if (far > kFarForLocal) {
    cloud.warnings.push_back(
        fmt::format("{}: some points lie {:.0f} km from the first one; remove such outliers, they "
                    "cost precision",
                    name, far / 1000.0F));
  }
  return cloud;
}

void warnOfRest(std::size_t count, std::string_view unit, Cloud& cloud) {
  if (count == 0) return;
  cloud.warnings.push_back(
      fmt::format("{}: {} {} after the last point, ignored", cloud.name, count, unit));
}

}  // namespace agricolmap::io
