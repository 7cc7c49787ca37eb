#include "agricolmap/io/cloud/record_move.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "agricolmap/io/output/write_behind.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 14;  ///< records that one thread moves at a time
constexpr std::size_t kTogether = 8;
/// Samples are taken from so many places: each brings a large page of the file into memory.
constexpr std::size_t kPlaces = 32;
constexpr std::size_t kPerPlace = 32;
/// Written between two times that the memory of the source is given back.
constexpr std::size_t kForgetAfter = std::size_t{1} << 26;

}  // namespace

std::optional<ThreeFields> findNormal(const std::vector<std::string_view>& names,
                                      const std::string& file) {
  const auto normal = findFields(names, {"nx", "ny", "nz"}, file);
  return normal ? normal : findFields(names, {"normal_x", "normal_y", "normal_z"}, file);
}

RecordLayout::RecordLayout(const std::vector<RecordField>& fields, const PointFields& points,
                           bool as_double, bool swap)
    : swap_(swap) {
  const auto axisOf = [](const ThreeFields& indices, std::size_t field) {
    return static_cast<std::size_t>(std::find(indices.begin(), indices.end(), field) -
                                    indices.begin());
  };
  if (points.normal && std::all_of(points.normal->begin(), points.normal->end(),
                                   [&](auto field) { return isFloating(fields[field].type); })) {
    normal_ = std::array<Value, 3>{};
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    Value value{before_, after_, fields[i].type, fields[i].type};
    std::size_t bytes_after = fields[i].bytes;
    if (const std::size_t axis = axisOf(points.xyz, i); axis < 3) {
      if (as_double) {
        value.type_after = ScalarType::kFloat64;
        bytes_after = sizeof(double);
      }
      xyz_[axis] = value;
    }
    if (const std::size_t axis = normal_ ? axisOf(*points.normal, i) : 3; axis < 3) {
      (*normal_)[axis] = value;
    }
    // What follows what was kept is kept with it.
    const bool joined = !kept_.empty() && kept_.back().before + kept_.back().bytes == before_ &&
                        kept_.back().after + kept_.back().bytes == after_;
    if (bytes_after == fields[i].bytes && joined) {
      kept_.back().bytes += bytes_after;
    } else if (bytes_after == fields[i].bytes) {
      kept_.push_back({before_, after_, bytes_after});
    }
    before_ += fields[i].bytes;
    after_ += bytes_after;
  }
}

double RecordLayout::load(const Value& value, const std::byte* record) const {
  if (value.type_before == ScalarType::kFloat64 && !swap_) {
    double number = 0.0;
    std::memcpy(&number, record + value.before, sizeof(number));
    return number;
  }
  return loadScalar(record + value.before, value.type_before, swap_);
}

void RecordLayout::store(const Value& value, std::byte* record, double number) const {
  std::byte* const to = record + value.after;
  if (value.type_after == ScalarType::kFloat32) {
    auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(number));
    if (swap_) bits = __builtin_bswap32(bits);
    std::memcpy(to, &bits, sizeof(bits));
    return;
  }
  auto bits = std::bit_cast<std::uint64_t>(number);
  if (swap_) bits = __builtin_bswap64(bits);
  std::memcpy(to, &bits, sizeof(bits));
}

Eigen::Vector3d RecordLayout::pointOf(const std::byte* record) const {
  return {load(xyz_[0], record), load(xyz_[1], record), load(xyz_[2], record)};
}

MoveTally RecordLayout::move(const PointMover& mover, const std::byte* from, std::size_t count,
                             std::byte* to) const {
  MoveTally tally;
  CoordinateBlock block;
  for (std::size_t begin = 0; begin < count; begin += block.count) {
    block.count = std::min(CoordinateBlock::kCapacity, count - begin);
    for (std::size_t i = 0; i < block.count; ++i) {
      const std::byte* const before = from + (begin + i) * before_;
      std::byte* const after = to + (begin + i) * after_;
      for (const Kept& kept : kept_) {
        std::memcpy(after + kept.after, before + kept.before, kept.bytes);
      }
      block.set(i, pointOf(before));
      if (!normal_) continue;
      const auto& n = *normal_;
      const Eigen::Vector3d turned =
          mover.turned({load(n[0], before), load(n[1], before), load(n[2], before)});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        store(n[axis], after, turned[static_cast<Eigen::Index>(axis)]);
      }
    }
    tally += mover.move(block);
    for (std::size_t i = 0; i < block.count; ++i) {
      std::byte* const after = to + (begin + i) * after_;
      for (std::size_t axis = 0; axis < 3; ++axis) store(xyz_[axis], after, block.xyz[axis][i]);
    }
  }
  return tally;
}

bool becomesDouble(const std::vector<RecordField>& fields, const PointFields& points,
                   const PointMover& mover) {
  return std::any_of(points.xyz.begin(), points.xyz.end(), [&](std::size_t i) {
    return !isFloating(fields[i].type) ||
           (fields[i].type == ScalarType::kFloat32 && mover.needsDouble());
  });
}

std::vector<Eigen::Vector3d> samplesOf(const RecordLayout& layout, const std::byte* first,
                                       std::size_t count) {
  const std::size_t stride = std::max(kPerPlace, count / kPlaces);
  std::vector<Eigen::Vector3d> samples;
  for (std::size_t begin = 0; begin < count; begin += stride) {
    for (std::size_t i = begin; i < std::min(count, begin + kPerPlace); ++i) {
      samples.push_back(layout.pointOf(first + i * layout.lengthBefore()));
    }
  }
  return samples;
}

MoveTally writeMoved(const RecordLayout& layout, const PointMover& mover, const std::byte* first,
                     std::size_t count, FileSink& sink, const CopyProgress& progress,
                     const std::function<void()>& forget) {
  struct Piece {
    std::vector<std::byte> bytes;
    std::size_t points = 0;
    MoveTally tally;
  };
  MoveTally tally;
  std::size_t written = 0;
  std::size_t unforgotten = 0;
  writeBehind<Piece>((count + kPiece - 1) / kPiece, kTogether,
                     [&](std::size_t i, Piece& piece) {
                       piece.points = std::min(kPiece, count - i * kPiece);
                       piece.bytes.resize(piece.points * layout.lengthAfter());
                       piece.tally = layout.move(mover, first + i * kPiece * layout.lengthBefore(),
                                                 piece.points, piece.bytes.data());
                     },
                     [&](const Piece& piece) {
                       sink.write(piece.bytes);
                       tally += piece.tally;
                       written += piece.points;
                       unforgotten += piece.bytes.size();
                       if (unforgotten < kForgetAfter) return;
                       unforgotten = 0;
                       forget();
                       if (progress) progress(written, count);
                     });
  return tally;
}

}  // namespace agricolmap::io
