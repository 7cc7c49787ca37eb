#include "agricolmap/io/las/las_points.hpp"

#include <algorithm>

namespace agricolmap::io {
namespace {

/// Uncompressed: the records lie in the file as they are.
class PlainPoints : public LasPoints {
 public:
  PlainPoints(const std::byte* first, const LasHeader& header)
      : first_(first),
        points_(static_cast<std::size_t>(header.points)),
        length_(header.layout.length) {}

  std::size_t chunks() const override { return (points_ + kChunk - 1) / kChunk; }
  std::size_t firstPoint(std::size_t chunk) const override { return chunk * kChunk; }
  void decode(std::size_t chunk, LasWanted /*wanted*/, const Sink& sink) const override {
    const std::size_t begin = chunk * kChunk;
    sink(first_ + begin * length_, std::min(kChunk, points_ - begin));
  }

 private:
  static constexpr std::size_t kChunk = 1U << 14;
  const std::byte* first_;
  std::size_t points_;
  std::size_t length_;
};

}  // namespace

std::unique_ptr<LasPoints> lasPoints(std::span<const std::byte> bytes, const LasHeader& header,
                                     const std::string& name) {
  if (header.compressed) return lazPoints(bytes, header, name);
  return std::make_unique<PlainPoints>(bytes.data() + header.points_begin, header);
}

}  // namespace agricolmap::io
