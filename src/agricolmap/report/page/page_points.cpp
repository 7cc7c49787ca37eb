#include "agricolmap/report/page/page_points.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <tuple>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/report/page/page_text.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPoints = 120'000;  // of each cloud: a megabyte of page
constexpr double kRim = 1.5;                  // of the fixed cloud around the strip [m]
constexpr double kFinestStep = 0.001;         // [m]
constexpr double kSteps = 65535.0;

struct Ranked {
  std::uint64_t rank = 0;
  Eigen::Vector3f xyz;
  Rgb rgb;
};

/// A point's own lot, by its coordinates: streams of the same points hand them over in different
/// pieces (splitmix64).
std::uint64_t rankOf(const Eigen::Vector3f& point) {
  std::uint64_t state = 0;
  for (int axis = 0; axis < 3; ++axis) {
    state += 0x9e3779b97f4a7c15ULL + std::bit_cast<std::uint32_t>(point[axis]);
    state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ULL;
    state = (state ^ (state >> 27)) * 0x94d049bb133111ebULL;
    state ^= state >> 31;
  }
  return state;
}

/// Leaves the `most` of the lowest ranks.
void keepLowest(std::vector<Ranked>& points, std::size_t most) {
  if (points.size() <= most) return;
  const auto end = points.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(points.begin(), end, points.end(),
                   [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
  points.erase(end, points.end());
}

/// Bits of x and y taken in turn: neighbours in the field are neighbours in the list.
std::uint32_t mortonCode(std::uint16_t x, std::uint16_t y) {
  std::uint32_t code = 0;
  for (unsigned bit = 0; bit < 16; ++bit) {
    code |= ((x >> bit) & 1U) << (2 * bit) | ((y >> bit) & 1U) << (2 * bit + 1);
  }
  return code;
}

std::vector<std::uint8_t> gzipped(const std::vector<std::uint8_t>& bytes) {
  constexpr int kGzip = 15 + 16;
  constexpr int kMemory = 8;
  constexpr int kLevel = 3;  // little is repeated: more effort gains a hundredth
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  stream.next_in = const_cast<Bytef*>(bytes.data());  // zlib's interface; it only reads
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::bad_alloc();
  return out;
}

/// Where points of the moving cloud lie, local coordinates of the fixed one.
class Laid {
 public:
  Laid(const PointStream& fixed, const Cloud& moving, const pipeline::Registration& registration,
       const Eigen::Affine3d& guess)
      : moving_origin_(moving.origin),
        local_(registration.transform
                   ? registration.transform->local_fixed_from_moving
                   : Eigen::Affine3d(Eigen::Translation3d(-fixed.facts().origin) * guess *
                                     Eigen::Translation3d(moving.origin))) {
    if (registration.bent()) displacement_.emplace(registration, moving);
  }
  Eigen::Vector3d operator()(const Eigen::Vector3f& local) const {
    const Eigen::Vector3d point = local.cast<double>();
    if (!displacement_) return local_ * point;
    return local_ * point + displacement_->at(moving_origin_ + point);
  }

 private:
  Eigen::Vector3d moving_origin_;
  Eigen::Affine3d local_;
  std::optional<pipeline::Displacement> displacement_;
};

}  // namespace

PointSample samplePoints(const PointStream& cloud, const Eigen::Affine3d& frame_from_local,
                         const Eigen::AlignedBox2d& window, std::size_t most) {
  std::vector<Ranked> kept;
  std::uint64_t highest = std::numeric_limits<std::uint64_t>::max();
  PointSample sample;
  const bool coloured = cloud.facts().coloured;
  cloud.passNear(frame_from_local, window, [&](const PointBatch& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Eigen::Vector3d place = frame_from_local * batch.xyz[i].cast<double>();
      if (!window.contains(place.head<2>())) continue;
      ++sample.of;
      const std::uint64_t rank = rankOf(batch.xyz[i]);
      if (rank >= highest) continue;
      kept.push_back({rank, batch.xyz[i], coloured ? batch.rgb[i] : Rgb{}});
      if (kept.size() < 2 * most) continue;
      keepLowest(kept, most);
      highest = std::max_element(kept.begin(), kept.end(), [](const Ranked& a, const Ranked& b) {
                  return a.rank < b.rank;
                })->rank;
    }
  });
  keepLowest(kept, most);
  for (const Ranked& point : kept) {
    sample.xyz.push_back(point.xyz);
    if (coloured) sample.rgb.push_back(point.rgb);
  }
  return sample;
}

Json packedPoints(PointSample sample) {
  const std::size_t count = sample.xyz.size();
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : sample.xyz) box.extend(point);
  if (count == 0) box.extend(Eigen::Vector3f::Zero());
  const double step = std::max(kFinestStep, static_cast<double>(box.sizes().maxCoeff()) / kSteps);
  using Steps = std::array<std::uint16_t, 3>;
  std::vector<std::tuple<std::uint32_t, Steps, std::size_t>> order(count);
  parallelFor(
      count,
      [&](std::size_t i) {
        Steps steps{};
        for (int axis = 0; axis < 3; ++axis) {
          const double away = static_cast<double>(sample.xyz[i][axis] - box.min()[axis]) / step;
          steps[static_cast<std::size_t>(axis)] =
              static_cast<std::uint16_t>(std::clamp(std::round(away), 0.0, kSteps));
        }
        order[i] = {mortonCode(steps[0], steps[1]), steps, i};
      },
      1U << 12);
  std::sort(order.begin(), order.end());
  // Planes of low and high bytes of each axis' differences, then of the colours.
  const bool coloured = !sample.rgb.empty();
  std::vector<std::uint8_t> bytes((coloured ? 9 : 6) * count);
  Steps before{};
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [code, steps, i] = order[k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto difference = static_cast<std::uint16_t>(steps[axis] - before[axis]);
      bytes[2 * axis * count + k] = static_cast<std::uint8_t>(difference & 255U);
      bytes[(2 * axis + 1) * count + k] = static_cast<std::uint8_t>(difference >> 8);
    }
    before = steps;
    if (!coloured) continue;
    const Rgb colour = sample.rgb[i];
    bytes[6 * count + k] = colour.r;
    bytes[7 * count + k] = colour.g;
    bytes[8 * count + k] = colour.b;
  }
  return {{"count", count},
          {"of", sample.of},
          {"coloured", coloured},
          {"step_m", step},
          {"min_m", {box.min().x(), box.min().y(), box.min().z()}},
          {"extent_m", {box.sizes().x(), box.sizes().y(), box.sizes().z()}},
          {"gzip_base64", base64(gzipped(bytes))}};
}

Json pagePoints(const PointStream& fixed, const Cloud& moving,
                const pipeline::Registration& registration, const Eigen::Affine3d& guess) {
  const auto& frames = registration.maps.frames;
  PointSample strip = samplePoints(CloudStream(moving), frames.levelled_from_moving,
                                   registration.maps.moving_box, kMostPoints);
  const Laid laid(fixed, moving, registration, guess);
  Eigen::AlignedBox2d window;
  for (Eigen::Vector3f& point : strip.xyz) {
    point = laid(point).cast<float>();
    window.extend(point.head<2>().cast<double>());
  }
  if (strip.xyz.empty()) return nullptr;
  window.min().array() -= kRim;
  window.max().array() += kRim;
  PointSample ground = samplePoints(fixed, Eigen::Affine3d::Identity(), window, kMostPoints);
  return {{"fixed", packedPoints(std::move(ground))},
          {"moving", packedPoints(std::move(strip))},
          {"rim_m", kRim}};
}

}  // namespace agricolmap::report
