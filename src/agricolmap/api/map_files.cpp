#include "agricolmap/io/raster/map_files.hpp"

#include <optional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/io.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap {
namespace {

io::FileCrs crsOf(const MapFile& file) { return io::crsOfMap(io::mapFilesOf(file.path), file.crs); }

Cloud readInto(const MapFile& file, const io::CoordinateMap* map, const io::CommonFrame& frame) {
  Cloud cloud = io::readMap(io::mapFilesOf(file.path), {true, map});
  cloud.crs = frame.crs;
  return cloud;
}

void addWarnings(const io::CommonFrame& frame, Cloud& cloud) {
  cloud.warnings.insert(cloud.warnings.end(), frame.warnings.begin(), frame.warnings.end());
}

}  // namespace

bool sameCrs(const Crs& a, const Crs& b) {
  requireProcessor();
  const auto nameOf = [](const Crs& crs) { return crs.name.empty() ? "a map" : crs.name; };
  return io::sameHorizontally(nameOf(a), a.wkt, nameOf(b), b.wkt);
}

CloudPair readPair(const MapFile& fixed, const MapFile& moving) {
  requireProcessor();
  const io::CommonFrame frame = io::commonFrame(crsOf(fixed), crsOf(moving));
  CloudPair pair;
  // Two files, two cores: the disk cache feeds both.
  parallelFor(2, [&](std::size_t i) {
    if (i == 0) {
      pair.fixed = readInto(fixed, frame.fixed.get(), frame);
    } else {
      pair.moving = readInto(moving, frame.moving.get(), frame);
    }
  });
  addWarnings(frame, pair.moving);
  io::checkGroundScale(pair.fixed.name, frame.crs, pair.fixed.origin.head<2>());
  return pair;
}

Cloud readBeside(const Crs& frame_crs, const MapFile& moving) {
  requireProcessor();
  io::FileCrs fixed;
  fixed.name = "the fixed cloud";
  if (!frame_crs.wkt.empty()) fixed.crs = frame_crs;
  const io::CommonFrame frame = io::commonFrame(fixed, crsOf(moving));
  Cloud cloud = readInto(moving, frame.moving.get(), frame);
  addWarnings(frame, cloud);
  return cloud;
}

Cloud readMap(const MapFile& file, const std::string& target) {
  requireProcessor();
  const io::FileCrs crs = crsOf(file);
  const io::CommonFrame frame =
      target.empty() ? io::commonFrame(crs, crs) : io::frameIn(crs, target);
  Cloud cloud = readInto(file, frame.moving.get(), frame);
  addWarnings(frame, cloud);
  return cloud;
}

}  // namespace agricolmap
