#include "agricolmap/io/cloud/cloud_reader.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/pcd_reader.hpp"
#include "agricolmap/io/cloud/ply_reader.hpp"
#include "agricolmap/io/cloud/xyz_reader.hpp"
#include "agricolmap/io/las/las_reader.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/matrix_file.hpp"

namespace agricolmap::io {
namespace {

std::string remedyFor(std::string_view bytes) {
  std::string known = describeForeign(bytes);
  if (!known.empty()) return known;
  if (looksLikeMatrix(bytes)) {
    return "it is a 4x4 matrix, as transformations are written; give the cloud itself; were these "
           "four points, a first line would have to name their columns, as 'x y z intensity'";
  }
  return "known are LAS, LAZ, PLY, PCD and text with lines 'x y z' or 'x y z r g b'";
}

/// The points of another source, brought into other coordinates.
class MappedSource : public PointSource {
 public:
  MappedSource(std::unique_ptr<PointSource> source, const CoordinateMap& map)
      : source_(std::move(source)), map_(map) {}
  std::size_t points() const override { return source_->points(); }
  std::size_t chunks() const override { return source_->chunks(); }
  std::size_t firstPoint(std::size_t chunk) const override { return source_->firstPoint(chunk); }
  ColourKind colourKind() const override { return source_->colourKind(); }
  bool floatCoordinates() const override { return source_->floatCoordinates(); }
  bool dear() const override { return true; }
  bool marked() const override { return source_->marked(); }
  void decode(std::size_t chunk, const Sink& sink) const override {
    source_->decode(chunk, [&](const PointBlock& block) {
      PointBlock mapped = block;
      map_.apply(mapped.xyz[0].data(), mapped.xyz[1].data(), mapped.xyz[2].data(), block.count);
      sink(mapped);
    });
  }

 private:
  std::unique_ptr<PointSource> source_;
  const CoordinateMap& map_;
};

PointFile openAs(CloudFormat format, const MappedFile& file, const std::string& name,
                 const ReadOptions& options) {
  switch (format) {
    case CloudFormat::kPly:
      return openPly(file, name, options);
    case CloudFormat::kPcd:
      return openPcd(file, name, options);
    case CloudFormat::kXyz:
      return openXyz(file, name, options);
    case CloudFormat::kLas:
    case CloudFormat::kLaz:
    case CloudFormat::kCopc:
      break;
  }
  return openLas(file, name, options);
}

}  // namespace

PointFile openPoints(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  const auto format = formatByContent(file.text());
  if (!format) {
    throw InputError(fmt::format("{}: not a point cloud: {}", name, remedyFor(file.text())));
  }
  PointFile opened = openAs(*format, file, name, options);
  if (options.map != nullptr) {
    opened.source = std::make_unique<MappedSource>(std::move(opened.source), *options.map);
  }
  return opened;
}

Cloud readCloud(const std::filesystem::path& path, const ReadOptions& options) {
  const MappedFile file(path);
  return assembleCloud(openPoints(file, path.string(), options));
}

}  // namespace agricolmap::io
