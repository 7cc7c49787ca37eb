#include "agricolmap/deform/deform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/deform/bend_fit.hpp"
#include "agricolmap/deform/rise_fit.hpp"

namespace agricolmap::deform {

void listOptions(OptionTable& table, BendOptions& options) {
  table.number("node", options.node, 0.2, 100.0, "m",
               "distance of the displacement's nodes along the path");
  table.number("min_gain", options.min_gain, 0.0, 1000.0, "standard errors",
               "by which blocks that were left out of its fit must confirm it");
  table.number("min_evidence", options.min_evidence, 0.0, 1e6, "",
               "or how much likelier it must make them: logarithm");
  table.number("min_rise", options.min_rise, 0.0, 10.0, "m",
               "drift of the height from which on it is followed, root mean square");
}

namespace {

/// Grid cells a cell of the levels: 6 and 4 cm.
constexpr int kCoarse = 3;
constexpr int kFine = 2;
constexpr double kBin = 0.12;        // along the path [m]
constexpr double kSlipPlace = 0.06;  // what its place is good to [m]
constexpr double kNarrowBin = 0.03;  // to place slips [m]
constexpr int kLeastBins = 24;
constexpr double kStartStiffness = 1e4;  // of the coarse level [m]
constexpr std::size_t kMostSlips = 4;
constexpr int kSlipRounds = 3;
constexpr double kLeastClearGain = 1.0;
constexpr double kLeastGain = 3.0;     // of the rise [standard errors]
constexpr double kLeastLength = 2.0;   // of a strip [m]
constexpr double kLeastOffset = 0.05;  // of a slip [m]

BinLayout layoutOf(const Path& path) {
  return {path.length(), std::max(kLeastBins, static_cast<int>(path.length() / kBin))};
}

/// A fit and where its slips are.
struct Fitted {
  std::vector<double> slips;
  BendFit fit;
};

/// Puts the slips where they lie best, and fits again.
Fitted refitted(const StripBins& bins, const SplineBasis& basis, Fitted fitted) {
  for (int round = 0; round < kSlipRounds && !fitted.slips.empty(); ++round) {
    const BendModel model(basis, fitted.slips, bins);
    const std::vector<double> placed =
        placedSlips(bins, model, fitted.fit.coefficients, fitted.fit.residual);
    if (placed == fitted.slips) break;
    fitted.slips = placed;
    fitted.fit = fitBend(bins, BendModel(basis, fitted.slips, bins), fitted.fit.coefficients);
  }
  return fitted;
}

Fitted withFurtherSlips(const StripBins& bins, const SplineBasis& basis, Fitted fitted) {
  while (fitted.slips.size() < kMostSlips) {
    const BendModel model(basis, fitted.slips, bins);
    const std::optional<double> further = furtherSlip(bins, model, fitted.fit);
    if (!further) break;
    Fitted more;
    more.slips = fitted.slips;
    more.slips.push_back(*further);
    const BendModel next(basis, more.slips, bins);
    Eigen::VectorXd start = Eigen::VectorXd::Zero(next.size());
    start.head(model.size()) = fitted.fit.coefficients;
    more.fit = fitBend(bins, next, start);
    more = refitted(bins, basis, std::move(more));
    const Eigen::Vector2d offset = more.fit.coefficients.tail<2>();
    if (more.fit.evidence <= fitted.fit.evidence || offset.norm() < kLeastOffset) break;
    fitted = std::move(more);
  }
  return fitted;
}

Fitted fitted(const refine::PairSignals& signals, const Eigen::Affine2d& pose, const Path& path,
              const SplineBasis& basis, const std::vector<PieceOffset>& pieces) {
  const BinLayout layout = layoutOf(path);
  Fitted result;
  result.slips = jumpsBetween(pieces);
  Eigen::VectorXd start;
  {
    const refine::SignalPair level = signals.whole(kCoarse);
    const StripBins bins(level.fixed, level.moving, pose, path, layout);
    const BendModel model(basis, result.slips, bins);
    start = throughPieces(model, pieces, kStartStiffness);
    refine::Noise noise;
    start = bendTo(bins, model, std::move(start), kStartStiffness, noise);
    if (!result.slips.empty()) {
      result.slips = placedSlips(bins, model, start, noise);
      start = bendTo(bins, BendModel(basis, result.slips, bins), std::move(start), kStartStiffness,
                     noise);
    }
  }
  const map::SignalMap fixed = signals.fixedSignals(pose, kFine);
  const StripBins bins(fixed, signals.filled(kFine), pose, path, layout);
  result.fit = fitBend(bins, BendModel(basis, result.slips, bins), start);
  result = refitted(bins, basis, std::move(result));
  result = withFurtherSlips(bins, basis, std::move(result));
  if (!result.slips.empty()) {
    // A slip misplaced by a bin costs centimetres.
    const BinLayout narrow{path.length(), static_cast<int>(path.length() / kNarrowBin)};
    const StripBins finer(fixed, signals.filled(kFine), pose, path, narrow);
    result.slips = placedSlips(finer, BendModel(basis, result.slips, finer),
                               result.fit.coefficients, result.fit.residual);
  }
  return result;
}

/// Least squares of the displacement over the map's cells in what is an affine as well where the
/// path is straight: shift, and along the path turn and stretch. Takes them from the deformation
/// and returns them as an affine of the moving frame to come before the deformation, in
/// displacements.
void moveStraightPart(const map::SignalMap& moving, Bend& bend) {
  Deformation& deformation = bend.deformation;
  const Path& path = deformation.path();
  const double length = deformation.basis().length();
  const Eigen::Vector2d ahead = deformation.tangent(0.5 * length);
  Eigen::Matrix4d normal = 1e-9 * Eigen::Matrix4d::Identity();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  // Of shift x, y and slope x, y along the path; the slope's part across turns what lies aside.
  const auto jacobian = [&](double along, double aside) {
    Eigen::Matrix<double, 2, 4> j;
    const double u = along - 0.5 * length;
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    j.leftCols<2>().setIdentity();
    j.rightCols<2>() = u * Eigen::Matrix2d::Identity() - aside * ahead * left.transpose();
    return j;
  };
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      const Eigen::Vector2d p = moving.frame.centre(r, c);
      const PathPlace place = path.place(p);
      const auto j = jacobian(place.along, place.aside);
      normal += j.transpose() * j;
      right += j.transpose() * deformation.at(p).head<2>();
    }
  }
  const Eigen::Vector4d part = normal.ldlt().solve(right);
  for (int i = 0; i < deformation.basis().size(); ++i) {
    const double u = deformation.basis().place(i) - 0.5 * length;
    deformation.coefficients.row(i).head<2>() -= (part.head<2>() + u * part.tail<2>()).transpose();
  }
  // The same as an affine.
  const Eigen::Vector2d tangent = path.tangent(0.5 * length);
  const Eigen::Vector2d normal_to(-tangent.y(), tangent.x());
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Eigen::Vector2d middle = path.point(0.5 * length);
  const Eigen::Matrix2d slope = part.tail<2>() * tangent.transpose() -
                                left.dot(part.tail<2>()) * ahead * normal_to.transpose();
  bend.pose.linear() += slope;
  bend.pose.translation() += part.head<2>() - slope * middle;
}

/// Of a path that turns no stretch or turn along it is an affine as well: the shift alone is taken
/// from the deformation.
void moveShift(const map::SignalMap& moving, Bend& bend) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      sum += bend.deformation.at(moving.frame.centre(r, c)).head<2>();
      count += 1.0;
    }
  }
  if (count == 0.0) return;
  const Eigen::Vector2d shift = sum / count;
  bend.deformation.coefficients.leftCols<2>().rowwise() -= shift.transpose();
  bend.pose.pretranslate(shift);
}

/// Largest horizontal displacement on the path [m].
double mostOf(const Deformation& deformation) {
  double most = 0.0;
  const int places = 4 * deformation.basis().size();
  for (int i = 0; i <= places; ++i) {
    const double along = deformation.basis().length() * i / places;
    most = std::max(most, deformation.onPath(along).head<2>().norm());
  }
  return most;
}

void measureSize(const map::SignalMap& moving, Bend& bend) {
  const Deformation& deformation = bend.deformation;
  double sum = 0.0, count = 0.0;
  for (int r = 0; r < moving.frame.rows; ++r) {
    for (int c = 0; c < moving.frame.cols; ++c) {
      if (moving.weight(r, c) <= 0.0F) continue;
      sum += deformation.at(moving.frame.centre(r, c)).head<2>().squaredNorm();
      count += 1.0;
    }
  }
  bend.rms = count > 0.0 ? std::sqrt(sum / count) : 0.0;
  bend.most = mostOf(deformation);
}

void addRise(const refine::PairSignals& signals, const refine::VerticalResult& heights,
             const BendOptions& options, Bend& bend) {
  const std::optional<RiseFit> rise = fitRise(signals.fixed().grid(), signals.moving().grid(),
                                              bend.pose, heights, bend.deformation);
  if (!rise || rise->gain < kLeastGain) return;
  bend.deformation.coefficients.col(2) = rise->coefficients;
  // The whole's height and slope stay those of the ground: this is about what they leave.
  const double length = bend.deformation.basis().length();
  double sum = 0.0;
  constexpr int kPlaces = 50;
  for (int i = 0; i <= kPlaces; ++i) {
    sum += std::pow(bend.deformation.onPath(length * i / kPlaces).z(), 2);
  }
  bend.deformation.height_deviation = rise->deviation;
  if (std::sqrt(sum / (kPlaces + 1)) < options.min_rise) {
    bend.deformation.coefficients.col(2).setZero();
    bend.deformation.height_deviation = 0.0;
  }
}

Bend bendOf(const Fitted& fitted, const Path& path, const SplineBasis& basis,
            const Eigen::Affine2d& pose) {
  Bend bend{.deformation = Deformation(path, pose.linear().colwise().normalized(), basis),
            .pose = pose,
            .gain = fitted.fit.gain,
            .evidence = fitted.fit.evidence};
  Deformation& deformation = bend.deformation;
  for (int i = 0; i < basis.size(); ++i) {
    deformation.coefficients.row(i).head<2>() =
        fitted.fit.coefficients.segment<2>(unknownOf(i)).transpose();
  }
  // Those that were found last may lie before others.
  std::vector<std::size_t> order(fitted.slips.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return fitted.slips[a] < fitted.slips[b]; });
  std::vector<int> ordered(static_cast<std::size_t>(fitted.fit.coefficients.size()));
  std::iota(ordered.begin(), ordered.end(), 0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const int at = 2 * (basis.size() + static_cast<int>(order[k]));
    const std::size_t to = 2 * (static_cast<std::size_t>(basis.size()) + k);
    ordered[to] = at;
    ordered[to + 1] = at + 1;
    deformation.slips.push_back({fitted.slips[order[k]], fitted.fit.coefficients.segment<2>(at),
                                 std::sqrt(0.5 * fitted.fit.covariance.block<2, 2>(at, at).trace()),
                                 kSlipPlace});
  }
  deformation.covariance = fitted.fit.covariance(ordered, ordered);
  return bend;
}

/// A bend spares all left-out blocks a little; a slip few of them much, so that their gains differ
/// by as much as they are.
bool confirmed(const BendFit& fit, const BendOptions& options) {
  return fit.gain >= options.min_gain ||
         (fit.gain >= kLeastClearGain && fit.evidence >= options.min_evidence);
}

}  // namespace

std::optional<Bend> followBend(const refine::PairSignals& signals, const Eigen::Affine2d& pose,
                               const refine::VerticalResult& heights, const Path& path,
                               const std::vector<PieceOffset>& pieces, const BendOptions& options) {
  if (path.length() < kLeastLength) return std::nullopt;
  const SplineBasis basis(path.length(), options.node);
  const Fitted best = fitted(signals, pose, path, basis, pieces);
  if (!best.fit.coefficients.allFinite() || !confirmed(best.fit, options)) return std::nullopt;
  Bend bend = bendOf(best, path, basis, pose);
  const map::SignalMap& moving = signals.moving().at(kCoarse);
  if (path.straight()) {
    moveStraightPart(moving, bend);
  } else {
    moveShift(moving, bend);
  }
  measureSize(moving, bend);
  addRise(signals, heights, options, bend);
  return bend;
}

}  // namespace agricolmap::deform
