#include "agricolmap/pieces/chain.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::pieces {

void listOptions(OptionTable& table, PiecesOptions& options) {
  table
      .number("from", options.from, 1.0, 1e6, "m",
              "strips longer than this are placed piece by piece along their path")
      .basic();
  table.number("piece", options.piece, 1.0, 1000.0, "m",
               "length of a piece; neighbours overlap by half of it");
  table
      .number("drift", options.drift, 0.0, 0.5, "",
              "by how much dead reckoning may be off, share of the way")
      .basic();
  table.number("slip", options.slip, 0.1, 5.0, "m",
               "how far from where its neighbour puts it a piece is looked for");
}

namespace {

/// What a piece may be off by even where it has hardly moved on [m].
constexpr double kSlack = 0.06;
/// A place far from where the neighbour puts the piece costs so many deviations and no more: slips
/// happen.
constexpr double kSlipCost = 4.0;
/// Farther than this from the peak is chance [m].
constexpr double kOwnPeak = 0.35;
constexpr std::size_t kLeastFar = 50;
/// A peak that is lower, or not so much higher than the highest of chance, is no place.
constexpr double kLeastSignificance = 5.0;
constexpr double kLeastUniqueness = 1.25;
/// A piece's own scales and turn differ from its neighbour's by no more: beyond, only its shift
/// counts.
constexpr double kMostChange = 0.03;
constexpr double kLeastFilled = 0.2;  // of a piece's area, for it to be looked for

/// The moving map's cells of one piece.
struct PieceMap {
  Eigen::AlignedBox2d bounds;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< on the path [m]
  std::size_t cells = 0;
};

/// Places every cell of the moving map by the path once.
class PathCells {
 public:
  PathCells(const map::SignalMap& map, const deform::Path& path)
      : map_(map), path_(path), along_(map.frame.rows, map.frame.cols, kNowhere) {
    parallelFor(
        static_cast<std::size_t>(map.frame.rows),
        [&](std::size_t item) {
          const int r = static_cast<int>(item);
          for (int c = 0; c < map.frame.cols; ++c) {
            if (map.weight(r, c) <= 0.0F) continue;
            along_(r, c) = static_cast<float>(path.place(map.frame.centre(r, c)).along);
          }
        },
        8);
  }

  bool inside(const Eigen::Vector2d& point, const PiecePose& piece) const {
    const Eigen::Vector2d at = map_.frame.cellOf(point).array().round();
    const int r = static_cast<int>(at.y()), c = static_cast<int>(at.x());
    return along_.contains(r, c) && within(along_(r, c), piece);
  }

  PieceMap of(const PiecePose& piece) const {
    PieceMap found;
    for (int r = 0; r < along_.rows(); ++r) {
      for (int c = 0; c < along_.cols(); ++c) {
        if (!within(along_(r, c), piece)) continue;
        found.bounds.extend(map_.frame.centre(r, c));
        ++found.cells;
      }
    }
    found.middle = path_.point(piece.middle());
    return found;
  }

  /// The signals of a piece alone.
  map::SignalMap signals(const PiecePose& piece, const PieceMap& found) const {
    const Eigen::Vector2d low = map_.frame.cellOf(found.bounds.min()).array().round();
    const Eigen::Vector2d high = map_.frame.cellOf(found.bounds.max()).array().round();
    const int row0 = static_cast<int>(low.y()), col0 = static_cast<int>(low.x());
    map::SignalMap part;
    part.frame = map_.frame;
    part.frame.corner += map_.frame.cell * Eigen::Vector2d(col0, row0);
    part.frame.rows = static_cast<int>(high.y()) - row0 + 1;
    part.frame.cols = static_cast<int>(high.x()) - col0 + 1;
    part.weight = Raster<float>(part.frame.rows, part.frame.cols);
    for (int k = 0; k < map::kSignalChannels; ++k) {
      part.channel[k] = part.weight;
      part.deviation[k] = map_.deviation[k];
    }
    for (int r = 0; r < part.frame.rows; ++r) {
      for (int c = 0; c < part.frame.cols; ++c) {
        if (!within(along_(row0 + r, col0 + c), piece)) continue;
        part.weight(r, c) = map_.weight(row0 + r, col0 + c);
        for (int k = 0; k < map::kSignalChannels; ++k) {
          part.channel[k](r, c) = map_.channel[k](row0 + r, col0 + c);
        }
      }
    }
    return part;
  }

 private:
  static constexpr float kNowhere = -1e9F;
  static bool within(float along, const PiecePose& piece) {
    return static_cast<double>(along) >= piece.from && static_cast<double>(along) < piece.to;
  }

  const map::SignalMap& map_;
  const deform::Path& path_;
  Raster<float> along_;
};

/// The best of the shifts around a prediction.
struct Peak {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]
  double significance = 0.0;
  double uniqueness = 0.0;
};

Peak peakOf(const Raster<float>& scores, double cell, double deviation_of_place, double limit) {
  const int reach = scores.rows() / 2;
  const auto distance = [&](int r, int c) { return std::hypot(r - reach, c - reach) * cell; };
  double sum2 = 0.0;
  for (const float s : scores) sum2 += static_cast<double>(s) * static_cast<double>(s);
  const double rough = std::sqrt(sum2 / static_cast<double>(scores.size()));
  Peak peak;
  if (rough <= 0.0) return peak;
  // What is better than chance by so many deviations is worth that much off the expected place.
  double best = -1e30;
  int best_row = reach, best_col = reach;
  for (int r = 0; r < scores.rows(); ++r) {
    for (int c = 0; c < scores.cols(); ++c) {
      const double off = distance(r, c);
      if (off > limit) continue;
      const double cost = std::min(kSlipCost, 0.5 * std::pow(off / deviation_of_place, 2));
      const double value = static_cast<double>(scores(r, c)) / rough - cost;
      if (value > best) best = value, best_row = r, best_col = c;
    }
  }
  double far2 = 0.0, other = 0.0;
  std::size_t far = 0;
  for (int r = 0; r < scores.rows(); ++r) {
    for (int c = 0; c < scores.cols(); ++c) {
      if (std::hypot(r - best_row, c - best_col) * cell <= kOwnPeak) continue;
      const auto score = static_cast<double>(scores(r, c));
      far2 += score * score;
      ++far;
      if (distance(r, c) <= limit) other = std::max(other, score);
    }
  }
  if (far < kLeastFar || far2 <= 0.0) return peak;
  const double chance = std::sqrt(far2 / static_cast<double>(far));
  const auto highest = static_cast<double>(scores(best_row, best_col));
  peak.shift = cell * Eigen::Vector2d(best_col - reach, best_row - reach);
  peak.significance = highest / chance;
  peak.uniqueness = highest / std::max(chance, other);
  return peak;
}

class Follower {
 public:
  Follower(const refine::PairSignals& signals, const deform::Path& path,
           const PiecesOptions& options, const refine::DenseRefineOptions& dense)
      : score_(signals.score()), options_(options), dense_(dense), cells_(score_.moving(), path) {}

  /// Places `piece` near to where `predicted` puts it, its way from there being `way` [m].
  void place(PiecePose& piece, const Eigen::Affine2d& predicted, double way) const {
    piece.pose = predicted;
    piece.held = false;
    const PieceMap found = cells_.of(piece);
    const double cell = score_.moving().frame.cell;
    if (static_cast<double>(found.cells) * cell * cell < kLeastFilled * (piece.to - piece.from)) {
      return;
    }
    const correlation::Template whole = correlation::makeTemplate(
        score_.moving(), found.middle, predicted.linear(), found.bounds, cell, score_.options(),
        [&](const Eigen::Vector2d& p) { return cells_.inside(p, piece); });
    const double deviation = kSlack + options_.drift * way;
    const int reach = static_cast<int>(std::ceil((options_.slip + kOwnPeak) / cell));
    const Eigen::Vector2d at = score_.fixed().frame.cellOf(predicted * found.middle);
    const Eigen::Vector2d rounding = cell * (at.array().round().matrix() - at);
    const Peak peak = peakOf(score_.around(whole, at, reach), cell, deviation, options_.slip);
    piece.significance = peak.significance;
    if (peak.significance < kLeastSignificance || peak.uniqueness < kLeastUniqueness) return;
    piece.held = true;
    piece.pose = Eigen::Translation2d(peak.shift + rounding) * predicted;
    const refine::DenseRefineResult refined =
        refine::refineDense(score_.fixed(), cells_.signals(piece, found), piece.pose, dense_);
    if (refined.status != refine::RefineStatus::kConverged) return;
    const Eigen::Matrix2d change =
        predicted.linear().inverse() * refined.fixed_from_moving.linear();
    if ((change - Eigen::Matrix2d::Identity()).cwiseAbs().maxCoeff() > kMostChange) return;
    piece.pose = refined.fixed_from_moving;
  }

 private:
  const correlation::StripScore& score_;
  const PiecesOptions& options_;
  const refine::DenseRefineOptions& dense_;
  PathCells cells_;
};

}  // namespace

std::vector<PiecePose> cutPath(double length, const PiecesOptions& options) {
  const double step = 0.5 * std::min(options.piece, length);
  const int count = std::max(1, static_cast<int>(std::lround(length / step)) - 1);
  const double even = length / (count + 1);
  std::vector<PiecePose> pieces;
  for (int i = 0; i < count; ++i) {
    PiecePose piece;
    piece.from = even * i;
    piece.to = even * (i + 2);
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<PiecePose> followPath(const refine::PairSignals& signals, const deform::Path& path,
                                  double along, const Eigen::Affine2d& pose,
                                  const PiecesOptions& options,
                                  const refine::DenseRefineOptions& dense) {
  std::vector<PiecePose> chain = cutPath(path.length(), options);
  const Follower follower(signals, path, options, dense);
  const auto nearest =
      std::min_element(chain.begin(), chain.end(), [&](const PiecePose& a, const PiecePose& b) {
        return std::abs(a.middle() - along) < std::abs(b.middle() - along);
      });
  const auto first = static_cast<std::ptrdiff_t>(nearest - chain.begin());
  follower.place(*nearest, pose, 0.0);
  const auto count = static_cast<std::ptrdiff_t>(chain.size());
  // Each way on its own.
  parallelFor(2, [&](std::size_t side) {
    const std::ptrdiff_t step = side == 0 ? 1 : -1;
    // The last piece that was found: what it says goes on.
    std::ptrdiff_t known = first;
    for (std::ptrdiff_t i = first + step; i >= 0 && i < count; i += step) {
      const PiecePose& before = chain[static_cast<std::size_t>(known)];
      PiecePose& piece = chain[static_cast<std::size_t>(i)];
      follower.place(piece, before.pose, std::abs(piece.middle() - before.middle()));
      if (piece.held) known = i;
    }
  });
  return chain;
}

double significanceOf(const std::vector<PiecePose>& chain) {
  double sum2 = 0.0;
  for (const PiecePose& piece : chain) {
    if (piece.held) sum2 += 0.5 * piece.significance * piece.significance;
  }
  return std::sqrt(sum2);
}

double deviationOf(const std::vector<PiecePose>& chain, const deform::Path& path) {
  double sum2 = 0.0, pairs = 0.0;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (!chain[i - 1].held || !chain[i].held) continue;
    const Eigen::Vector2d shared = path.point(0.5 * (chain[i].from + chain[i - 1].to));
    sum2 += (chain[i].pose * shared - chain[i - 1].pose * shared).squaredNorm();
    pairs += 1.0;
  }
  // Two axes of two pieces each.
  return pairs > 0.0 ? std::sqrt(sum2 / (4.0 * pairs)) : 0.0;
}

std::optional<Joined> joined(const std::vector<PiecePose>& chain, const deform::Path& path,
                             double half_width) {
  std::vector<const PiecePose*> held;
  for (const PiecePose& piece : chain) {
    if (piece.held) held.push_back(&piece);
  }
  if (held.size() < 2) return std::nullopt;
  Eigen::MatrixX3d places(2 * held.size(), 3);
  Eigen::MatrixX2d goals(2 * held.size(), 2);
  Eigen::Index row = 0;
  for (const PiecePose* piece : held) {
    for (const double aside : {-half_width, half_width}) {
      const Eigen::Vector2d point = path.point(piece->middle(), aside);
      places.row(row) << point.x(), point.y(), 1.0;
      goals.row(row++) = (piece->pose * point).transpose();
    }
  }
  const Eigen::Matrix<double, 3, 2> fit = places.colPivHouseholderQr().solve(goals);
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  pose.linear() = fit.topRows<2>().transpose();
  pose.translation() = fit.row(2).transpose();
  const Eigen::Affine2d back = pose.inverse();
  std::vector<BendNode> nodes;
  const auto add = [&](double along, const PiecePose& piece) {
    const Eigen::Vector2d point = path.point(along);
    const Eigen::Vector2d shift = back * (piece.pose * point) - point;
    nodes.push_back({along, {shift.x(), shift.y(), piece.lift}});
  };
  add(held.front()->from, *held.front());
  for (const PiecePose* piece : held) add(piece->middle(), *piece);
  add(held.back()->to, *held.back());
  Joined result{pose, Bend(path, nodes), 0.0};
  for (const BendNode& node : nodes) result.largest = std::max(result.largest, node.shift.norm());
  return result;
}

}  // namespace agricolmap::pieces
