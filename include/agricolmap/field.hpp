// One map of a field from a drone's cloud and the strips that were laid into it, and what stands on
// the field: rows, plants, gaps, weeds, heights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/options.hpp"
#include "agricolmap/register.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// Options by name; those that are not named have their defaults.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// A strip that lies in the fixed cloud's coordinates.
struct LaidStrip {
  std::string name;
  std::shared_ptr<const Cloud> cloud;
  double plane_error_m = 1.0;  ///< expected RMS in the plane; as it stands: nobody knows
  double height_error_m = 1.0;
  bool heights_limited = false;  ///< its heights say nothing of the fixed cloud's
  int date = 0;                  ///< YYYYMMDD; 0: nobody said
};

/// The moving cloud where the registration lays it, with the errors that it states. Throws
/// UsageError as alignedCloud does.
AGRICOLMAP_EXPORT LaidStrip laidStrip(const std::string& name, const Cloud& moving,
                                      const Registration& registration, int date = 0);

/// What a map says of every cell of a field. Values are row-major, row 0 is the southernmost; NaN
/// where nothing is known.
struct FieldMap {
  /// What a strip shows in cells of its own, where it owns those of the map; NaN elsewhere.
  struct Fine {
    int rows = 0;
    int cols = 0;
    double cell_m = 0.0;
    /// (column, row, surface or ground [m]) → file coordinates [m], as the map's.
    Transform file_from_cell = Transform::Identity();
    std::vector<float> plant_height_m;
    std::vector<float> excess_green;
    std::vector<float> cover;
    std::vector<float> density;  ///< points per m²
  };
  /// A strip in it.
  struct Strip {
    std::string name;
    std::uint16_t source = 0;                           ///< in the layer of that name
    Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();  ///< to agree with strips that overlap it
    double seen_m2 = 0.0;
    double owned_m2 = 0.0;  ///< what it has in the map
    Fine fine;              ///< without cells where that is nothing
  };

  /// What the fixed cloud is known by: maps of one hang on one frame.
  struct Source {
    std::string name;
    std::uint64_t points = 0;
    int date = 0;  ///< YYYYMMDD; 0: nobody said
    bool operator==(const Source&) const = default;
  };

  int rows = 0;
  int cols = 0;
  double cell_m = 0.0;
  /// (column, row, surface or ground [m]) → file coordinates [m]. Corners of cells are whole
  /// numbers.
  Transform file_from_cell = Transform::Identity();
  Crs crs;
  std::vector<float> surface_m;
  std::vector<float> ground_m;
  std::vector<float> plant_height_m;  ///< surface less ground
  std::vector<float> excess_green;
  std::vector<float> cover;           ///< share of the cell that is vegetation, 0 to 1
  std::vector<float> density;         ///< points per m²
  std::vector<float> plane_error_m;   ///< expected RMS, against the fixed cloud
  std::vector<float> height_error_m;  ///< expected RMS of the surface
  std::vector<Rgb> colour;
  std::vector<std::uint16_t> source;  ///< 0 nothing, 1 the fixed cloud, else a strip's
  std::vector<std::int32_t> date;     ///< YYYYMMDD; 0: nobody said
  bool has_heights = true;            ///< else the layers of heights are all NaN
  Source fixed;                       ///< that the strips lie in
  std::vector<Strip> strips;
  std::vector<std::string> warnings;
};

/// The options of fuseClouds.
AGRICOLMAP_EXPORT std::vector<OptionInfo> fuseOptions();

/// Strips' cells replace the fixed cloud's where strips have seen, its heights are led to theirs,
/// and corrected over plants as strips show. Order of the strips does not count. Throws InputError
/// when a strip does not touch the fixed cloud, UsageError for options and when there are no strips
/// or two of one name, Interrupted. Control::on_stage hears of its steps.
AGRICOLMAP_EXPORT FieldMap fuseClouds(const Cloud& fixed, const std::vector<LaidStrip>& strips,
                                      const Settings& options = {}, const Control& control = {},
                                      int fixed_date = 0);

/// Component gdal. A map as the command line's `fuse` wrote it, by its folder, or a surface model
/// of any program, a GeoTIFF. Surface and ground are as high as the files say; layers that it does
/// not have are NaN, of a surface model all others and its errors. Throws InputError.
AGRICOLMAP_EXPORT FieldMap readFieldMap(const std::filesystem::path& path);

/// A polygon of the file's coordinates and what it is called.
struct Plot {
  std::string name;
  std::vector<Eigen::Vector2d> corners;  ///< not closed [m]
};

/// What stands on a field, or a part of it.
struct CropFacts {
  struct Stand {
    double area_m2 = 0.0;     ///< that the map shows
    double cover = 0.0;       ///< share of it that is green
    double weeds = 0.0;       ///< share of what is between rows that is under weeds
    std::size_t patches = 0;  ///< of weeds
    double row_length_m = 0.0;
    double plants = 0.0;      ///< expected, and one per spacing where they cannot be told apart
    double plants_low = 0.0;  ///< hold the truth nine times in ten, on simulated fields
    double plants_high = 0.0;
    std::size_t counted = 0;   ///< plants told apart
    double uncounted_m = 0.0;  ///< of the rows, where they cannot be
    std::size_t gaps = 0;
    double gap_length_m = 0.0;
    double height_low_m = 0.0;  ///< that a tenth of the plants is below; NaN where not known
    double height_middle_m = 0.0;
    double height_high_m = 0.0;  ///< that nine tenths are below
  };
  struct Row {
    std::vector<Eigen::Vector2d> line;  ///< file coordinates [m]
    Stand stand;
  };
  struct Plant {
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< file coordinates
    std::size_t row = 0;                                ///< index in `rows`
    double along_m = 0.0;                               ///< of the row
    double area_m2 = 0.0;                               ///< green
    double height_m = 0.0;   ///< of its highest tenth, above the ground; NaN where not known
    double certainty = 1.0;  ///< that it is one plant, and no less than one
  };
  struct Gap {
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< its middle, file coordinates
    std::size_t row = 0;
    double from_m = 0.0;  ///< along the row
    double to_m = 0.0;
  };
  struct Weed {
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< file coordinates
    double area_m2 = 0.0;
  };
  struct Square {
    Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< south-west, file coordinates
    double side_m = 0.0;
    Stand stand;
  };

  bool countable = false;        ///< plants could be told apart somewhere
  double row_spacing_m = 0.0;    ///< 0: there are no rows
  double row_heading_deg = 0.0;  ///< counter-clockwise from x
  double plant_spacing_m = 0.0;  ///< 0: plants cannot be counted
  Stand total;
  std::vector<Row> rows;
  std::vector<Plant> plants;
  std::vector<Gap> gaps;
  std::vector<Weed> weeds;      ///< between rows
  std::vector<Square> squares;  ///< that the map shows something of
  std::vector<Stand> plots;     ///< as those given
};

/// The options of cropFacts.
AGRICOLMAP_EXPORT std::vector<OptionInfo> factsOptions();

/// Of a cloud, in cells as fine as its points. Throws InputError for clouds that cannot be used,
/// when plants do not stand out from soil and when there are plots but none on the map; UsageError,
/// Interrupted.
AGRICOLMAP_EXPORT CropFacts cropFacts(const Cloud& cloud, const Settings& options = {},
                                      const std::vector<Plot>& plots = {},
                                      const Control& control = {});
/// The same of a map, in its cells, and in those of its strips where they are finer: as the command
/// line counts.
AGRICOLMAP_EXPORT CropFacts cropFacts(const FieldMap& map, const Settings& options = {},
                                      const std::vector<Plot>& plots = {},
                                      const Control& control = {});

}  // namespace agricolmap
