// Sparse features of a map: what is detected, how it is described, how it is matched.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/locate/association.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::experiments {

/// A map's Excess Green as a picture.
struct ExgImage {
  Raster<std::uint8_t> grey;   ///< 0–255: from the first to the last percentile of the map
  Raster<std::uint8_t> known;  ///< 1 where the map's cell is filled
};

/// Empty cells are filled smoothly from those around them: a hard border would be the strongest
/// feature of a strip.
ExgImage exgImage(const map::GridMap& map);

/// Keypoints with descriptors of equal length, either real or binary.
struct Features {
  std::vector<Eigen::Vector2d> cells;  ///< (col, row), 0 at the centre of cell 0
  Eigen::MatrixXf real;                ///< one column each; empty when binary
  std::vector<std::uint8_t> bits;      ///< `bytes` each; empty when real
  std::size_t bytes = 0;
  std::size_t size() const { return cells.size(); }
};

class FeatureExtractor {
 public:
  FeatureExtractor() = default;
  virtual ~FeatureExtractor() = default;
  FeatureExtractor(const FeatureExtractor&) = delete;
  FeatureExtractor& operator=(const FeatureExtractor&) = delete;
  virtual std::string name() const = 0;
  /// Features whose keypoints lie on known cells. Deterministic.
  virtual Features extract(const ExgImage& image) const = 0;
};

/// Keeps the features whose keypoint lies on a known cell.
Features onKnownGround(const Features& features, const ExgImage& image);

struct MatchOptions {
  /// Lowe's ratio of the nearest to the second nearest; 1: any. Crops repeat, so that a ratio
  /// leaves next to nothing: where a vote follows, it does the choosing.
  double ratio = 1.0;
};

/// Pairs of features that are each other's nearest among those that the guess allows; levelled
/// frames [m].
std::vector<Match> matchFeatures(const Features& fixed, const GridFrame& fixed_frame,
                                 const Features& moving, const GridFrame& moving_frame,
                                 const SearchSpace& space, const MatchOptions& options);

}  // namespace agricolmap::experiments
