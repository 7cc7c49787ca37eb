// Binary records of which only coordinates and normals change: PLY's and PCD's.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agricolmap/io/cloud/named_fields.hpp"
#include "agricolmap/io/cloud/point_mover.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {

/// One of the values that a record is made of, in their order.
struct RecordField {
  ScalarType type = ScalarType::kFloat32;
  std::size_t bytes = 0;
};

/// Which of a point's fields are its coordinates and its normal.
struct PointFields {
  ThreeFields xyz{};
  std::optional<ThreeFields> normal;
};

/// Which fields are a normal, where there is one; `names` as for findField.
std::optional<ThreeFields> findNormal(const std::vector<std::string_view>& names,
                                      const std::string& file);

/// How records are laid out before and after: coordinates may have become doubles.
class RecordLayout {
 public:
  RecordLayout(const std::vector<RecordField>& fields, const PointFields& points, bool as_double,
               bool swap);

  std::size_t lengthBefore() const { return before_; }
  std::size_t lengthAfter() const { return after_; }
  Eigen::Vector3d pointOf(const std::byte* record) const;
  /// Copies and moves `count` records.
  MoveTally move(const PointMover& mover, const std::byte* from, std::size_t count,
                 std::byte* to) const;

 private:
  struct Value {
    std::size_t before = 0;  ///< bytes from the beginning of the record
    std::size_t after = 0;
    ScalarType type_before = ScalarType::kFloat64;
    ScalarType type_after = ScalarType::kFloat64;
  };
  struct Kept {
    std::size_t before = 0;
    std::size_t after = 0;
    std::size_t bytes = 0;
  };
  double load(const Value& value, const std::byte* record) const;
  void store(const Value& value, std::byte* record, double number) const;

  std::vector<Kept> kept_;
  std::array<Value, 3> xyz_;
  std::optional<std::array<Value, 3>> normal_;
  std::size_t before_ = 0;
  std::size_t after_ = 0;
  bool swap_ = false;
};

/// Whether coordinates must be written as doubles: they are integers, or floats that are too coarse
/// for where they come to lie.
bool becomesDouble(const std::vector<RecordField>& fields, const PointFields& points,
                   const PointMover& mover);

/// Some of the points of records, spread over all of them.
std::vector<Eigen::Vector3d> samplesOf(const RecordLayout& layout, const std::byte* first,
                                       std::size_t count);

/// Moves `count` records behind what was written to `sink`. `forget` is called now and then.
MoveTally writeMoved(const RecordLayout& layout, const PointMover& mover, const std::byte* first,
                     std::size_t count, FileSink& sink, const CopyProgress& progress,
                     const std::function<void()>& forget);

}  // namespace agricolmap::io
