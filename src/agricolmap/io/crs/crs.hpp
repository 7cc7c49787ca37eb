// Coordinate systems: which one a cloud's file is in, and the common one, in metres, that two
// clouds are brought into. By GDAL and PROJ; crs_without_gdal.cpp stands for it where they are not
// built in.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/read_options.hpp"

namespace agricolmap::io {

/// What a file's coordinates mean: of a cloud as it stands on the disk.
struct FileCrs {
  std::string name;                   ///< the file, for messages
  std::optional<Crs> crs;             ///< nothing where nobody said
  std::vector<std::string> warnings;  ///< what could not be understood
};

/// By `given` (a code as EPSG:32632, WKT, PROJ's text or a file with one of these), unless it is
/// empty; else by the file itself (LAS); else by `<stem>.prj` or `<stem>_wkt.prj` beside it. Throws
/// UsageError for a `given` and InputError for a file beside that cannot be understood, InputError
/// when the cloud's file cannot be opened.
FileCrs crsOf(const std::filesystem::path& cloud, const std::string& given = "");

/// Of what a raster says; nothing where that is empty. Throws InputError when it is not understood.
std::optional<Crs> crsFromWkt(const std::string& wkt);

/// What brings two clouds into one coordinate system in metres.
struct CommonFrame {
  Crs crs;  ///< empty where nobody said; units are metres
  /// What the coordinates of the files themselves were taken to be in.
  std::optional<Crs> fixed_file;
  std::optional<Crs> moving_file;
  /// For ReadOptions; none where coordinates stay as they are.
  std::unique_ptr<CoordinateMap> fixed;
  std::unique_ptr<CoordinateMap> moving;
  bool moving_reprojected = false;  ///< no affine undoes what was done to it
  std::vector<std::string> warnings;
};

/// The frame of the fixed cloud, its units turned into metres. A cloud of which nothing is known is
/// taken to be in the other's, which is a warning. Where the fixed one is in degrees, the frame is
/// that of the moving one. Heights are brought to metres but not to another datum. Throws
/// InputError when neither is projected.
CommonFrame commonFrame(const FileCrs& fixed, const FileCrs& moving);

/// What brings one cloud into `target` (as `given` of crsOf), in metres. Throws UsageError when
/// that is not understood or not projected, InputError when the cloud does not say where it is.
CommonFrame frameIn(const FileCrs& cloud, const std::string& target);

/// Whether coordinates are degrees, or from the middle of the Earth: none that can be drawn on a
/// plane.
bool isProjected(const Crs& crs);

/// Whether they are metres, x, y and heights.
inline bool isInMetres(const Crs& crs) {
  return isProjected(crs) && crs.horizontal_unit == 1.0 && crs.vertical_unit == 1.0;
}

/// Throws InputError when a metre of the coordinate system at (x, y) is not one on the ground, to
/// 1 %: Web Mercator is wrong by the cosine of the latitude. Says nothing where `crs` is empty.
void checkGroundScale(const std::string& name, const Crs& crs, const Eigen::Vector2d& at);

}  // namespace agricolmap::io
