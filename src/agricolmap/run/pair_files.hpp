// The two files of a registration: read into one frame, and the moving one written where it
// belongs.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/point_move.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/pipeline/fixed_cloud.hpp"

namespace agricolmap::run {

/// Each the file of a cloud, an orthomosaic, or ORTHO.tif,DSM.tif.
struct PairFiles {
  std::string fixed;
  std::string moving;
  std::string fixed_crs;  ///< as the user says; empty: as the files do
  std::string moving_crs;
  std::string aligned = "auto";  ///< format of the aligned cloud
};

/// A fixed cloud, which passes by and is not kept.
struct LoadedFixed {
  explicit LoadedFixed(std::unique_ptr<PointStream> stream)
      : points(std::move(stream)), cloud(*points) {}
  std::unique_ptr<PointStream> points;
  pipeline::FixedCloud cloud;
};
/// Gives the fixed cloud of these files in the frame.
using FixedSource = std::function<std::shared_ptr<const LoadedFixed>(const io::MapFiles& files,
                                                                     const io::CommonFrame& frame)>;
/// As a stream for one registration, which the frame must outlive. `on_pass` hears of its points;
/// see StreamOptions.
std::shared_ptr<const LoadedFixed> streamedFixed(
    const io::MapFiles& files, const io::CommonFrame& frame,
    const std::function<void(std::size_t, std::size_t)>& on_pass = {});

/// What both are brought into.
io::CommonFrame frameOf(const PairFiles& files);

/// Both clouds in the coordinate system that they have in common, in metres.
struct LoadedPair {
  io::CommonFrame frame;
  std::optional<io::CloudFormat> format;            ///< of MOVING, unless it is a raster
  io::CloudFormat aligned = io::CloudFormat::kPly;  ///< of the aligned cloud
  std::shared_ptr<const LoadedFixed> fixed;
  Cloud moving;
};
LoadedPair loadPair(const PairFiles& files, const FixedSource& fixed);

/// The format that is called `name` ("copc"). Throws UsageError, naming what it is `of`, where none
/// is.
io::CloudFormat formatNamed(const std::string& of, const std::string& name);

/// "aligned.ply", for every format.
std::vector<std::string> alignedNames();

/// Writes the moving cloud, moved: from LAS to LAS, LAZ or COPC and from PLY to PLY point by point
/// with all attributes, else its coordinates and colours. What the caller should know is returned.
std::vector<std::string> writeAligned(const PairFiles& files, const LoadedPair& pair,
                                      const io::PointMove& fixed_from_moving,
                                      const io::StagedOutput& output);

/// What transform.txt says of itself; empty where nothing is known.
std::string transformComment(const LoadedPair& pair);

}  // namespace agricolmap::run
