// Where the robot drove: as it says, or as the strip's shape tells.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/deform/path.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::pieces {

/// The middle line of a strip, or why its shape does not tell one, in plain words with a remedy.
struct ShapePath {
  std::optional<deform::Path> path;
  std::string why_not;
};
/// Straight where the strip is, else a line through the middles of its slices. None for a map that
/// is nearly as wide as long, or whose slices are not all of about one width and filled: the strip
/// crosses itself or turns back.
ShapePath pathOfShape(const map::SignalMap& moving);

/// The path through places in the levelled frame of the moving map, as far as the map goes and
/// without the corners that make no difference. Throws InputError when it lies beside the map;
/// `name` is what it is called there.
deform::Path pathThrough(const std::vector<Eigen::Vector2d>& places, const map::SignalMap& moving,
                         const std::string& name);

/// Share of the path beside which it comes by again, nearer than `distance` [m].
double drivenTwice(const deform::Path& path, double distance);

}  // namespace agricolmap::pieces
