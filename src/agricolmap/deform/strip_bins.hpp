// The cells of a strip in bins along its path, and what each bin says of a displacement.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "agricolmap/deform/path.hpp"
#include "agricolmap/refine/residual.hpp"

namespace agricolmap::deform {

/// Of one bin: how the cells in it are moved, to first order about its middle.
struct BinMotion {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< on the path [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< derivative along the path [m/m]
};

/// Robust sums of one bin over (along, across, heading): a cell at t aside of the path moves by
/// (along − t · heading, across).
struct BinSums {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double cost = 0.0;   ///< robust, in squared deviations
  double cells = 0.0;  ///< that the fixed map sees, weighted
  BinSums& operator+=(const BinSums& other) {
    normal += other.normal;
    right += other.right;
    cost += other.cost;
    cells += other.cells;
    return *this;
  }
};

/// Bins of one length along the path, those of the left half behind those of the right.
struct BinLayout {
  double length = 0.0;  ///< of the path [m]
  int count = 0;        ///< along it
  double step() const { return length / count; }
  double middle(int bin) const { return step() * (bin % count + 0.5); }
  bool left(int bin) const { return bin >= count; }
  int size() const { return 2 * count; }
};

class StripBins {
 public:
  /// `pose`: moving levelled → fixed levelled frame. Both maps must outlive this and have cells of
  /// one size.
  StripBins(const map::SignalMap& fixed, const map::SignalMap& moving, const Eigen::Affine2d& pose,
            const Path& path, const BinLayout& layout);

  const BinLayout& layout() const { return layout_; }
  /// Directions of the path and to its left in a bin, fixed frame, unit length.
  const Eigen::Vector2d& ahead(int bin) const { return ahead_[static_cast<std::size_t>(bin)]; }
  /// Sums of all bins, moved so; `noise` is what residuals are measured by.
  std::vector<BinSums> sums(const std::vector<BinMotion>& motions,
                            const refine::Noise& noise) const;
  /// Gains and deviations under these motions.
  void updateNoise(const std::vector<BinMotion>& motions, refine::Noise& noise) const;
  bool usable() const { return cells_.size() >= 100; }

 private:
  struct Cell {
    float col, row;      ///< under the pose, fixed map
    float ahead, aside;  ///< from the bin's middle, from the path [m]
    float weight;
    float value[map::kSignalChannels];
  };
  template <typename Body>
  void forCells(int bin, const BinMotion& motion, const Body& body) const;

  const map::SignalMap& fixed_;
  BinLayout layout_;
  std::vector<Cell> cells_;          ///< in order of bins
  std::vector<std::size_t> begins_;  ///< of each bin's cells, and the end
  std::vector<Eigen::Vector2d> ahead_;
  bool used_[map::kSignalChannels];
};

}  // namespace agricolmap::deform
