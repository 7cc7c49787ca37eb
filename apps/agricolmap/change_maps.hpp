// The two maps of `agricolmap diff`, read onto one grid.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/change/height_change.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"
#include "agricolmap/report/page/scene_colours.hpp"

namespace agricolmap {

/// What a map's own layers, or the command line, expect of its errors [m].
struct GivenError {
  double height = 0.0;
  double plane = 0.0;
};

/// A shared map, or a surface model alone.
class ChangeMap {
 public:
  /// `error` counts instead of the map's layer `error`; `flag`: how it is given, for messages.
  /// Throws InputError for what cannot be used, UsageError when nothing is known of the errors of
  /// its heights.
  ChangeMap(const std::string& name, const std::optional<GivenError>& error, const char* flag);

  const std::string& name() const { return name_; }
  /// Whether its clouds have no heights, and it no surface: greenness alone is known then.
  bool flat() const { return folder_ && folder_->flat; }
  /// Of its surface, of a flat map its cover.
  const io::LayerShape& shape() const { return shape_; }
  const std::optional<report::StoredMap>& folder() const { return folder_; }

  /// Its colours, in its own cells where these lie on `grid`, about `origin`; without rasters where
  /// the map has none.
  report::ColourMap coloursOn(const GridFrame& grid, const Eigen::Vector3d& origin) const;
  /// Its heights on `grid`, which is about `origin` and within this map; not of a flat map.
  change::MapHeights heightsOn(const GridFrame& grid, const Eigen::Vector3d& origin,
                               std::vector<std::string>& warnings) const;
  /// One of its other layers; nothing where the map has none of that name.
  std::optional<Raster<float>> layerOn(const std::string& layer, const GridFrame& grid,
                                       const Eigen::Vector3d& origin) const;

 private:
  struct Part {
    io::CellWindow window;
    GridFrame frame;  ///< of the window, about the grid's origin
  };
  std::filesystem::path surfaceFile() const;
  std::filesystem::path layerFile(const char* layer) const;
  Part partFor(const GridFrame& grid, const Eigen::Vector3d& origin) const;
  void requireOwnGrid(const std::filesystem::path& file) const;
  Raster<float> surfaceIn(const io::CellWindow& window, std::vector<std::string>& warnings) const;
  void readErrors(const Part& part, const GridFrame& grid, change::MapHeights& heights) const;

  std::string name_;
  std::optional<GivenError> error_;
  std::optional<report::StoredMap> folder_;  ///< nothing for a file
  io::LayerShape shape_;
};

/// What two maps are compared on.
struct CommonGround {
  GridFrame frame;  ///< about `origin`
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::string crs;  ///< WKT; empty where neither map says
};

/// Throws InputError when the maps are in different coordinate systems, not in metres, or do not
/// overlap.
CommonGround commonGroundOf(const ChangeMap& a, const ChangeMap& b,
                            std::vector<std::string>& warnings);

}  // namespace agricolmap
