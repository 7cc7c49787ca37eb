// What the file formats have in common: points decoded in chunks, made into a Cloud.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/point_marks.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

enum class ScalarType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
};
std::size_t sizeOf(ScalarType type);
bool isFloating(ScalarType type);

/// How a file stores colours.
enum class ColourKind {
  kNone,
  kByte,         ///< 0–255
  kWideInteger,  ///< 0–255 or 0–65535, whichever holds the file's largest value
  kWideFloat,    ///< 0–1, or 0–255 when the file's largest value is above 1
};

inline bool isWide(ColourKind kind) {
  return kind == ColourKind::kWideInteger || kind == ColourKind::kWideFloat;
}

/// A few decoded points; small enough to stay in the cache.
struct PointBlock {
  static constexpr std::size_t kCapacity = 512;
  std::size_t count = 0;
  std::size_t withheld = 0;  ///< points before the block's last that the file says not to use
  std::array<std::array<double, kCapacity>, 3> xyz;  ///< file coordinates [m]
  std::array<Rgb, kCapacity> rgb;                    ///< ColourKind::kByte
  std::array<std::array<float, kCapacity>, 3> wide;  ///< the wide kinds
  std::array<PointMarks, kCapacity> marks;           ///< of a source that has some
};

/// The points of an open file. Chunks can be decoded from several threads at once.
class PointSource {
 public:
  using Sink = std::function<void(const PointBlock&)>;

  virtual ~PointSource() = default;
  virtual std::size_t points() const = 0;
  virtual std::size_t chunks() const = 0;
  /// Index of the chunk's first point.
  virtual std::size_t firstPoint(std::size_t chunk) const = 0;
  /// Hands the chunk's points to `sink`, block after block in file order.
  virtual void decode(std::size_t chunk, const Sink& sink) const = 0;
  virtual ColourKind colourKind() const = 0;
  /// Whether coordinates are stored as 32-bit floats, which are coarse far from zero.
  virtual bool floatCoordinates() const = 0;
  /// Whether decoding takes longer than writing what comes of it and reading that again: what is
  /// compressed, text, reprojected. Else chunks have few points.
  virtual bool dear() const { return false; }
  /// Whether blocks have marks.
  virtual bool marked() const { return false; }
};

/// One value per point, `stride` bytes apart.
struct Column {
  const std::byte* base = nullptr;
  std::size_t stride = 0;
  ScalarType type = ScalarType::kFloat32;
  bool swap = false;  ///< bytes in the other order than this machine's
};

/// Points of fixed size in memory: binary PLY and PCD, and the decompressed columns of PCD.
struct BinaryColumns {
  std::size_t points = 0;
  std::array<Column, 3> xyz;
  std::optional<std::array<Column, 3>> colour;
  std::optional<Column> packed;  ///< 0x00RRGGBB in 4 bytes; not together with `colour`
};

class BinarySource : public PointSource {
 public:
  explicit BinarySource(const BinaryColumns& columns) : columns_(columns) {}
  std::size_t points() const override { return columns_.points; }
  std::size_t chunks() const override { return (columns_.points + kChunk - 1) / kChunk; }
  std::size_t firstPoint(std::size_t chunk) const override { return chunk * kChunk; }
  void decode(std::size_t chunk, const Sink& sink) const override;
  ColourKind colourKind() const override;
  bool floatCoordinates() const override;

 private:
  static constexpr std::size_t kChunk = 1U << 14;
  void loadColours(std::size_t begin, PointBlock& block) const;
  BinaryColumns columns_;
};

/// A cloud's file, opened: its points, which look into it, and what is to be said beside them.
struct PointFile {
  std::string name;
  std::unique_ptr<PointSource> source;
  std::string fields;                 ///< what it has of each point
  std::vector<std::string> warnings;  ///< of its header
  std::vector<std::string> notes;     ///< warnings to stand behind those of its points
  bool black_is_none = false;         ///< colours that are black in all points stand for no colours
  /// What the points lie in, to be released now and then; none where they are in memory.
  const MappedFile* file = nullptr;
};

/// The kind of three stored colour channels.
ColourKind colourKindOf(const std::array<ScalarType, 3>& types);

/// One stored value as a double.
double loadScalar(const std::byte* from, ScalarType type, bool swap);

/// No field is so large: what lies farther from the origin is a placeholder or a mismatch [m].
inline constexpr double kMaxFromOrigin = 2e4;

/// Reads all points. The origin is the first point that says where
/// the cloud is, rounded to whole metres, or, where that lies more than 1 km off, the median of
/// about 1000 points spread over the file. Points with a coordinate or colour that is not finite,
/// and those more than 20 km from the origin along an axis, are dropped and counted, as are those
/// that are withheld, those at a height that stands for holes (see holeHeight), and the few whose
/// colours are outside the range of the others (see ColourTally). Throws InputError naming the file
/// when no point is left, when more are too far off than are left, or the colours fit no known
/// range.
Cloud assembleCloud(const PointFile& file);

/// Opens a cloud's file, told by its content; `file` and `options.map` must outlive it. Throws
/// InputError.
PointFile openPoints(const MappedFile& file, const std::string& name, const ReadOptions& options);

/// What a file has of each point as one text, printable and not too long.
std::string fieldList(const std::vector<std::string>& names);

/// Adds a note where `count` bytes or lines (`unit`) follow the last point.
void warnOfRest(std::size_t count, std::string_view unit, PointFile& file);

}  // namespace agricolmap::io
