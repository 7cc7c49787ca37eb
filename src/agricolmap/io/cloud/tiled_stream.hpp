// A cloud of any size of which many small parts are wanted, by several threads: decoded once and
// sorted on the disk by where its points are.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/output/scratch_file.hpp"

namespace agricolmap::io {

/// The points of another stream, to the bit, in their order and in the same batches, from a file
/// without a name in the scratch folder, of 16 bytes a point, 3 more with colours. A part of them
/// is read without the others. Can be passed by several threads at once.
class TiledStream : public PointStream {
 public:
  /// One pass over `source`, which is not needed afterwards. `tile`: least side of the tiles [m].
  /// Throws OutputError where the points find no room, and what the pass throws.
  explicit TiledStream(const PointStream& source, double tile = 5.0);

  const CloudFacts& facts() const override { return facts_; }
  Box3 box() const override { return box_; }
  void pass(const Visit& visit) const override;
  /// What lies in tiles that touch the window. Empty batches are left out.
  void passNear(const Eigen::Affine3d& frame_from_local, const Eigen::AlignedBox2d& window,
                const Visit& visit) const override;

 private:
  /// Tiles that are read together, by column and row; ends excluded.
  struct TileRange {
    int col0 = 0, col1 = 0, row0 = 0, row1 = 0;
  };
  struct Buffers;

  int colOf(float x) const;
  int rowOf(float y) const;
  TileRange tilesIn(const Eigen::AlignedBox2d& local) const;
  void store(const PointBatch& batch);
  void load(std::size_t batch, const TileRange& tiles, Buffers& buffers) const;
  void passTiles(const TileRange& tiles, const Visit& visit) const;
  std::uint64_t placeOf(std::size_t batch) const;

  CloudFacts facts_;
  Box3 box_;
  float tile_;  ///< side [m]
  int cols_ = 1;
  int rows_ = 1;
  /// Per batch of the source: its first point of each tile, counted within it, row by row; and the
  /// number of its points.
  std::vector<std::vector<std::uint32_t>> begins_;
  ScratchFile file_;
};

}  // namespace agricolmap::io
