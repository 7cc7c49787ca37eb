// summary.png: every map of a batch with the strips that were laid into it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/batch/record.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::batch {

/// A wide map as the picture shows it.
struct MapGround {
  std::string id;
  std::string name;  ///< of its file
  map::GridMap map;  ///< coarse, along the file's axes, about `origin`
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< file coordinates [m]
};

/// One pass over the cloud.
MapGround groundOf(const std::string& id, const PointStream& cloud);

/// Draws the strips of `records` on their maps. Throws OutputError.
void writeSummaryPicture(const io::OutputPath& path, std::span<const MapGround> grounds,
                         std::span<const Record> records);

}  // namespace agricolmap::batch
