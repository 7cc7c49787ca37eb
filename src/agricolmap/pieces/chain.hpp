// A long strip placed piece by piece: from one piece whose place is known to its neighbours, each
// looked for where dead reckoning lets it be. Costs what the strip is long.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/deform/path.hpp"
#include "agricolmap/pieces/bend.hpp"
#include "agricolmap/refine/dense_refine.hpp"
#include "agricolmap/refine/pair_signals.hpp"

namespace agricolmap::pieces {

struct PiecesOptions {
  double from = 24.0;   ///< strips longer than this are placed by pieces [m]
  double piece = 8.0;   ///< length of a piece; neighbours overlap by half of it [m]
  double drift = 0.04;  ///< deviation of dead reckoning, share of the way
  double slip = 1.0;    ///< how far off its neighbour's place a piece is looked for [m]
};
void listOptions(OptionTable& table, PiecesOptions& options);

/// A piece of the strip, placed alone.
struct PiecePose {
  double from = 0.0;  ///< along the path [m]
  double to = 0.0;
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< levelled moving → levelled fixed
  double significance = 0.0;  ///< of its peak, in deviations of what chance gives around it
  bool held = false;          ///< whether it was found; else where its neighbour puts it
  /// What its heights are short of at its middle, against one plane for all pieces [m].
  double lift = 0.0;

  double middle() const { return 0.5 * (from + to); }
};

/// Pieces of the path from its beginning to its end, `held` none.
std::vector<PiecePose> cutPath(double length, const PiecesOptions& options);

/// The strip followed from the piece nearest to `along` [m], where `pose` lays it, to both ends.
std::vector<PiecePose> followPath(const refine::PairSignals& signals, const deform::Path& path,
                                  double along, const Eigen::Affine2d& pose,
                                  const PiecesOptions& options,
                                  const refine::DenseRefineOptions& dense);

/// Of all pieces together: root of the sum of squares of those that were found, of which every
/// second is new.
double significanceOf(const std::vector<PiecePose>& chain);

/// What the place of a piece is off by, per axis [m]: from where neighbours that were found lay the
/// middle of what they share. 0 when no two are neighbours.
double deviationOf(const std::vector<PiecePose>& chain, const deform::Path& path);

/// A chain as one pose and what bends the strip so that it lies as its pieces do.
struct Joined {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< that is best for all pieces
  Bend bend;
  double largest = 0.0;  ///< displacement of a node [m]
};
/// Nothing when fewer than two pieces were found.
std::optional<Joined> joined(const std::vector<PiecePose>& chain, const deform::Path& path,
                             double half_width);

}  // namespace agricolmap::pieces
