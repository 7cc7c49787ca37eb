// What changed on a field between two maps of it, and what of that is more than their errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/field.hpp"
#include "agricolmap/register.hpp"

namespace agricolmap {

/// Expected RMS of a map's heights, and of its places, x and y together.
struct MapError {
  double height_m = 0.0;
  double plane_m = 0.0;
};

/// What diffMaps is told beside the maps.
struct DiffSettings {
  std::optional<MapError> error_a = std::nullopt;  ///< counts instead of the map's own
  std::optional<MapError> error_b = std::nullopt;
  /// Between the frames of both maps, as of two flights; no map knows it alone.
  std::optional<MapError> frame_error = std::nullopt;
  std::vector<Plot> plots = {};  ///< to compare in, too
  double grid_m = 0.0;  ///< side of squares to compare in, too, on round coordinates; 0: none
  /// The caller knows that coordinates of both maps mean the same, as sameCrs of the component gdal
  /// tells; else texts and names decide.
  bool same_crs = false;
};

/// What changed. Values are row-major, row 0 is the southernmost; NaN where one of the maps knows
/// nothing.
struct FieldChange {
  /// Of a set of cells. Deviations take what is expected of a cell to be one error of all cells of
  /// its source in its map: a larger field makes no volume surer.
  struct Share {
    std::size_t cells = 0;
    double area_m2 = 0.0;
    double volume_m3 = 0.0;      ///< mean change times area
    double volume_low_m3 = 0.0;  ///< these hold it in 95 of 100
    double volume_high_m3 = 0.0;
    double mean_m = 0.0;
    double mean_deviation_m = 0.0;
    double median_m = 0.0;
  };
  /// Of a layer beside the surface: medians of plant heights [m], where both maps have plants, or
  /// means of covers; NaN where nothing is known both times.
  struct Layer {
    std::size_t cells = 0;
    double before = 0.0;
    double after = 0.0;
  };
  /// Of a plot or a square.
  struct Part {
    double compared_m2 = 0.0;
    Share compared;
    Share rise;                     ///< cells whose change is more than errors, up
    Share fall;                     ///< and down
    double level_m = 0.0;           ///< what the mean must exceed
    bool more_than_errors = false;  ///< it does
    std::optional<Layer> plant_height;
    std::optional<Layer> cover;
  };
  struct Square {
    Eigen::Vector2d corner_m = Eigen::Vector2d::Zero();  ///< south-west, file coordinates
    double side_m = 0.0;
    Part change;
  };

  int rows = 0;
  int cols = 0;
  double cell_m = 0.0;  ///< of the map with the coarser cells
  /// (column, row, 0) → file coordinates [m]. Corners of cells are whole numbers.
  Transform file_from_cell = Transform::Identity();
  Crs crs;
  bool has_heights = true;                   ///< else covers alone were compared
  std::vector<float> height_change_m;        ///< of the surface, after less before
  std::vector<float> detection_m;            ///< what |change| exceeds at 5 % of unchanged cells
  std::vector<std::uint8_t> significant;     ///< 1 where it does
  std::vector<float> plant_height_change_m;  ///< empty: a map does not have the layer
  std::vector<float> cover_change;           ///< likewise
  MapError frame_error;                      ///< that was reckoned with
  Share compared;                            ///< all cells with a level of detection
  Share rise;                                ///< those whose change exceeds it, up
  Share fall;                                ///< and down
  double median_detection_m = 0.0;
  std::optional<Share> bare_ground;  ///< should not have moved; nothing: covers do not tell
  std::optional<Layer> plant_height;
  std::optional<Layer> cover;
  std::vector<Part> plots;      ///< as those given
  std::vector<Square> squares;  ///< of which both maps know something
  std::vector<std::string> warnings;
};

/// Compares two maps of a field on the grid of the one with the coarser cells. Throws InputError
/// when they say different coordinate systems, do not overlap or know nothing in common, and
/// when there are plots but none where they are compared; UsageError, Interrupted.
AGRICOLMAP_EXPORT FieldChange diffMaps(const FieldMap& map_a, const FieldMap& map_b,
                                       const DiffSettings& settings = {},
                                       const Control& control = {});

}  // namespace agricolmap
