#include "agricolmap/io/cloud/tiled_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <span>
#include <utility>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/cloud/point_spill.hpp"

namespace agricolmap::io {
namespace {

/// A table of where tiles begin costs 4 bytes for each tile and 2²⁰ points: 16 kB at most.
constexpr double kMostTiles = 4096.0;
constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

/// What a point takes; its number in the batch, too.
std::uint64_t pointBytes(bool coloured) {
  return sizeof(Eigen::Vector3f) + sizeof(std::uint32_t) + (coloured ? sizeof(Rgb) : 0);
}

std::string purposeOf(const CloudFacts& facts) {
  return fmt::format(
      "{}: its points, sorted by place, need {:.3g} GiB for a while in {}", facts.name,
      static_cast<double>(facts.points * pointBytes(facts.coloured)) / kGiB, scratchFolder());
}

Eigen::Vector3d corner(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int which) {
  return {(which & 1) == 0 ? low.x() : high.x(), (which & 2) == 0 ? low.y() : high.y(),
          (which & 4) == 0 ? low.z() : high.z()};
}

/// Where points that come to lie in `window` are in the cloud's own frame, seen from above; a
/// little more, as points are rounded.
Eigen::AlignedBox2d localWindow(const Box3& cloud, const Eigen::Affine3d& frame_from_local,
                                const Eigen::AlignedBox2d& window) {
  constexpr double kRounding = 0.1;  // [m]
  const Eigen::Vector3d low = cloud.min.cast<double>();
  const Eigen::Vector3d high = cloud.max.cast<double>();
  Eigen::AlignedBox3d whole;
  for (int i = 0; i < 8; ++i) whole.extend(frame_from_local * corner(low, high, i));
  const Eigen::Affine3d local_from_frame = frame_from_local.inverse();
  Eigen::Vector3d from = whole.min(), to = whole.max();
  from.head<2>() = window.min();
  to.head<2>() = window.max();
  Eigen::AlignedBox2d local;
  for (int i = 0; i < 8; ++i) local.extend((local_from_frame * corner(from, to, i)).head<2>());
  const Eigen::Vector2d rim = Eigen::Vector2d::Constant(kRounding);
  return {local.min() - rim, local.max() + rim};
}

int clampedCell(double at, int count) {
  return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

/// Memory of one pass.
struct TiledStream::Buffers {
  // As they are on the disk.
  std::vector<Eigen::Vector3f> tiled_xyz;
  std::vector<Rgb> tiled_rgb;
  std::vector<std::uint32_t> numbers;
  // In the order of the cloud.
  std::vector<std::uint32_t> place_of;  ///< by number: 1 + where it is above; 0: not there
  std::vector<Eigen::Vector3f> xyz;
  std::vector<Rgb> rgb;
};

TiledStream::TiledStream(const PointStream& source, double tile)
    : facts_(source.facts()),
      box_(source.box()),
      file_(scratchFolder(), purposeOf(facts_), "name another folder in TMPDIR") {
  const Eigen::Vector2d extent = box_.extent().head<2>().cast<double>().cwiseMax(0.0);
  tile_ = static_cast<float>(std::max(tile, std::sqrt(extent.prod() / kMostTiles)));
  const auto count = [&](double length) {
    return static_cast<int>(
        std::min(kMostTiles, std::floor(length / static_cast<double>(tile_)) + 1.0));
  };
  cols_ = count(extent.x());
  rows_ = count(extent.y());
  file_.reserve(facts_.points * pointBytes(facts_.coloured));
  source.pass([&](const PointBatch& batch) { store(batch); });
}

int TiledStream::colOf(float x) const { return clampedCell((x - box_.min.x()) / tile_, cols_); }
int TiledStream::rowOf(float y) const { return clampedCell((y - box_.min.y()) / tile_, rows_); }

std::uint64_t TiledStream::placeOf(std::size_t batch) const {
  return batch * kBatch * pointBytes(facts_.coloured);
}

void TiledStream::store(const PointBatch& batch) {
  throwIfInterrupted();
  const std::size_t count = batch.size();
  std::vector<std::uint32_t> tile_of(count);
  std::vector<std::uint32_t> begins(static_cast<std::size_t>(cols_) * rows_ + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f& p = batch.xyz[i];
    tile_of[i] = static_cast<std::uint32_t>(rowOf(p.y()) * cols_ + colOf(p.x()));
    ++begins[tile_of[i] + 1];
  }
  for (std::size_t tile = 1; tile < begins.size(); ++tile) begins[tile] += begins[tile - 1];
  std::vector<std::uint32_t> next = begins;
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[next[tile_of[i]]++] = static_cast<std::uint32_t>(i);
  }
  std::vector<Eigen::Vector3f> xyz(count);
  std::vector<Rgb> rgb(batch.rgb.size());
  for (std::size_t i = 0; i < count; ++i) xyz[i] = batch.xyz[numbers[i]];
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = batch.rgb[numbers[i]];
  const std::uint64_t place = placeOf(begins_.size());
  file_.write(place, std::as_bytes(std::span(xyz)));
  file_.write(place + count * sizeof(Eigen::Vector3f), std::as_bytes(std::span(numbers)));
  file_.write(place + count * (sizeof(Eigen::Vector3f) + sizeof(std::uint32_t)),
              std::as_bytes(std::span(rgb)));
  begins_.push_back(std::move(begins));
}

/// Reads a batch's points of these tiles and puts them in their order.
void TiledStream::load(std::size_t batch, const TileRange& tiles, Buffers& buffers) const {
  const std::vector<std::uint32_t>& begins = begins_[batch];
  const std::size_t in_batch = begins.back();
  const std::uint64_t xyz_place = placeOf(batch);
  const std::uint64_t number_place = xyz_place + in_batch * sizeof(Eigen::Vector3f);
  const std::uint64_t rgb_place = number_place + in_batch * sizeof(std::uint32_t);
  buffers.tiled_xyz.clear();
  buffers.tiled_rgb.clear();
  buffers.numbers.clear();
  // Tiles of a row lie one behind the other.
  const auto append = [&](auto& values, std::uint64_t place, std::size_t first, std::size_t count) {
    using Value = std::ranges::range_value_t<decltype(values)>;
    const std::size_t before = values.size();
    values.resize(before + count);
    file_.read(place + first * sizeof(Value),
               std::as_writable_bytes(std::span(values).subspan(before)));
  };
  for (int row = tiles.row0; row < tiles.row1; ++row) {
    const std::size_t row_begin = static_cast<std::size_t>(row) * cols_;
    const std::size_t first = begins[row_begin + tiles.col0];
    const std::size_t count = begins[row_begin + tiles.col1] - first;
    if (count == 0) continue;
    append(buffers.tiled_xyz, xyz_place, first, count);
    append(buffers.numbers, number_place, first, count);
    if (facts_.coloured) append(buffers.tiled_rgb, rgb_place, first, count);
  }
  const std::size_t count = buffers.numbers.size();
  buffers.xyz.clear();
  buffers.rgb.clear();
  if (count == 0) return;
  buffers.place_of.assign(in_batch, 0);
  for (std::size_t i = 0; i < count; ++i) {
    buffers.place_of[buffers.numbers[i]] = static_cast<std::uint32_t>(i + 1);
  }
  for (const std::uint32_t place : buffers.place_of) {
    if (place == 0) continue;
    buffers.xyz.push_back(buffers.tiled_xyz[place - 1]);
    if (facts_.coloured) buffers.rgb.push_back(buffers.tiled_rgb[place - 1]);
  }
}

void TiledStream::passTiles(const TileRange& tiles, const Visit& visit) const {
  Buffers buffers;
  for (std::size_t batch = 0; batch < begins_.size(); ++batch) {
    throwIfInterrupted();
    load(batch, tiles, buffers);
    if (!buffers.xyz.empty()) visit({buffers.xyz, buffers.rgb, batch * kBatch});
  }
}

void TiledStream::pass(const Visit& visit) const { passTiles({0, cols_, 0, rows_}, visit); }

TiledStream::TileRange TiledStream::tilesIn(const Eigen::AlignedBox2d& local) const {
  const Eigen::Array2d corner = box_.min.head<2>().cast<double>().array();
  const Eigen::Array2d low = (local.min().array() - corner) / tile_;
  const Eigen::Array2d high = (local.max().array() - corner) / tile_;
  if ((high < 0.0).any() || low.x() > cols_ || low.y() > rows_) return {};
  return {clampedCell(low.x(), cols_), clampedCell(high.x(), cols_) + 1,
          clampedCell(low.y(), rows_), clampedCell(high.y(), rows_) + 1};
}

void TiledStream::passNear(const Eigen::Affine3d& frame_from_local,
                           const Eigen::AlignedBox2d& window, const Visit& visit) const {
  passTiles(tilesIn(localWindow(box_, frame_from_local, window)), visit);
}

}  // namespace agricolmap::io
