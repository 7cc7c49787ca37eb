// Stage refine (paper Sec. IV): affine coherent point drift between vegetation points, from a good
// start to centimetres (Myronenko & Song, "Point set registration: coherent point drift", TPAMI
// 2010).
//
// What differs from the article:
// (1) The fixed points are the mixture and the moving ones the data: the ground robot's strip is
//     covered by the drone's map, not the reverse, and in the article's roles the drone's points
//     around the strip would stretch it.
// (2) The Gaussians are cut off at 3σ and found through a grid: the cost is that of near pairs.
// (3) σ shrinks level by level from the start's uncertainty, at least as fast as the article's
//     estimate of it. Points are merged to squares of σ/2 meanwhile, so that coarse levels cost
//     next to nothing. Within a level EM is accelerated: it crawls where plants are wider than σ.
// (4) A point is pulled to the mean of the fixed points around it *relative to* the mean of the
//     moving points around it. Without that, every point runs up the slope of its own plant, and
//     the map shrinks or stretches by up to a per cent as the plants at its edges happen to lie.
//     It needs the same surroundings in both maps, so points at the edge of what the moving map
//     shows only lend their surroundings to others.
// `kind = published` is the article's own algorithm (cpd_published.hpp) between the same points.
#pragma once

#include <Eigen/Geometry>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/vegetation.hpp"
#include "agricolmap/paper/cpd/cpd_published.hpp"

namespace agricolmap::paper {

enum class CpdKind {
  kAdapted,    ///< as above, with all options but `published`
  kPublished,  ///< the article's, with `published` alone
};

struct CpdOptions {
  CpdKind kind = CpdKind::kAdapted;
  PublishedCpdOptions published;
  double sigma_start = 0.15;   ///< σ of the first iteration: how wrong the start may be [m]
  double sigma_end = 0.025;    ///< least σ [m]
  double decay = 0.6;          ///< most of σ that is left from one level to the next
  double sigma_height = 0.15;  ///< deviation of the height difference [m]; 0: heights unused
  double outlier_share = 0.5;  ///< w, prior share of moving points without a counterpart
  double border = 2.0;         ///< nearer than this to the edge of the moving map: no data [σ]
  double start_weight = 0.15;  ///< pull of the start at sigma_start, per point; 0 at sigma_end
  int max_points = 40000;      ///< per cloud; more are merged to squares
  int max_iterations = 50;     ///< at one σ
  double tolerance = 1e-4;     ///< motion of the strip's points that counts as standing still [m]
  double max_motion = 0.5;     ///< motion from the start that is no refinement any more [m]
  double min_matched = 0.1;    ///< least share of the moving points matched in the end
};
void listOptions(OptionTable& table, CpdOptions& options);

enum class CpdStatus {
  kConverged,
  kIterationLimit,  ///< usable, still moving a little
  kTooFewPoints,    ///< fewer than 20 points on one side (after cropping to the overlap)
  kNoMatches,       ///< less than `min_matched` of the moving points found a counterpart
  kDegenerate,      ///< the matched points determine no affine map
  kRanAway,         ///< moved further than `max_motion`
};
std::string_view toString(CpdStatus status);

/// Where the refinement starts, and what it returns: fixed = plane · moving horizontally,
/// fixed_z = moving_z + height_offset; levelled frames [m]. Tilt and a vertical scale are not
/// estimated from the points: near-planar data cannot carry them.
struct CpdPose {
  Eigen::Affine2d plane = Eigen::Affine2d::Identity();
  double height_offset = 0.0;
};

struct CpdResult {
  CpdStatus status = CpdStatus::kTooFewPoints;
  CpdPose pose;                ///< refined; the start unless usable()
  double matched_share = 0.0;  ///< mean posterior of not being an outlier, of the data
  int iterations = 0;
  bool usable() const {
    return status == CpdStatus::kConverged || status == CpdStatus::kIterationLimit;
  }
};

/// Refines `start`, horizontally by any affine map. The article's kind takes the fixed points as
/// data, those within the outline of the moving ones under `start`, and finds any affine map in
/// three dimensions, however far; of its tilts the result keeps what they do to the plane at the
/// points' mean height. Failing to register is a status; the same result on any number of threads.
CpdResult refineByCpd(const std::vector<map::VegetationPoint>& fixed,
                      const std::vector<map::VegetationPoint>& moving, const CpdPose& start,
                      const CpdOptions& options);

}  // namespace agricolmap::paper
