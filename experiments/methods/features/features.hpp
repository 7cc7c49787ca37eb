// Sparse features of a map: what is detected, how it is described, how it is matched.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "agricolmap/core/placement.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::experiments {

/// A map's Excess Green as a picture; row 0 is the map's.
struct ExgImage {
  cv::Mat grey;   ///< 8 bit: from the first to the last percentile of the map
  cv::Mat known;  ///< 8 bit: 1 where the map's cell is filled
};

/// Empty cells are filled smoothly from those around them: a hard border would be the strongest
/// feature of a strip.
ExgImage exgImage(const map::GridMap& map);

/// Keypoints with descriptors.
struct Features {
  std::vector<Eigen::Vector2d> cells;  ///< (col, row), 0 at the centre of cell 0
  cv::Mat descriptors;                 ///< a row each: floats, or bits in bytes
  std::size_t size() const { return cells.size(); }
};

/// What finds the features whose keypoints lie on known cells. Deterministic.
using Extract = Features (*)(const ExgImage& image);
Features surfFeatures(const ExgImage& image);       ///< Bay et al. 2008; dlib's
Features orbFeatures(const ExgImage& image);        ///< OpenCV's
Features siftFeatures(const ExgImage& image);       ///< OpenCV's
Features fastBriefFeatures(const ExgImage& image);  ///< OpenCV's FAST with our BRIEF

/// BRIEF-32 (Calonder, Lepetit, Strecha & Fua, ECCV 2010), which Debian's OpenCV does not have, at
/// the cells of a picture: 256 comparisons of two smoothed pixels around each. The places are drawn
/// from an isotropic normal of variance S²/25 (the article's "G II", its best), the same for every
/// picture; pixels outside it are those of its rim.
cv::Mat briefOf(const cv::Mat& grey, const std::vector<Eigen::Vector2d>& cells);

/// Pairs of features that are each other's nearest among those that the guess allows; levelled
/// frames [m]. `ratio`: Lowe's, of the nearest to the second nearest; 1: any. Crops repeat, so that
/// a ratio leaves next to nothing: where a vote follows, it does the choosing.
std::vector<Match> matchFeatures(const Features& fixed, const GridFrame& fixed_frame,
                                 const Features& moving, const GridFrame& moving_frame,
                                 const SearchSpace& space, double ratio);

}  // namespace agricolmap::experiments
