// A cloud whose points pass by, batch after batch and as often as is asked: what looks at all of
// them needs no memory for all. A Cloud is one such stream, a file another (io/cloud/cloud_stream).
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"

namespace agricolmap {

/// What a cloud is, but for its points.
struct CloudFacts {
  std::string name;                                  ///< file it came from, for messages
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< file coordinates of the local zero [m]
  std::size_t points = 0;
  bool coloured = false;
  std::size_t dropped_points = 0;     ///< left out on reading
  std::vector<std::string> warnings;  ///< what its reader found odd, file named
  Crs crs;
  std::string fields;  ///< what its file has of each point
};
CloudFacts factsOf(const Cloud& cloud);

/// Points that follow each other, for as long as the visitor looks at them.
struct PointBatch {
  std::span<const Eigen::Vector3f> xyz;  ///< local coordinates [m]
  std::span<const Rgb> rgb;              ///< as many, or none where the cloud has no colours
  std::size_t first = 0;  ///< index of the first one in the cloud; of a part of one, nothing

  std::size_t size() const { return xyz.size(); }
};

class PointStream {
 public:
  /// Points per batch, but for the last: so what is summed batch by batch does not depend on where
  /// the points come from. A multiple of all chunks that work on a batch is cut into.
  static constexpr std::size_t kBatch = std::size_t{1} << 20;
  using Visit = std::function<void(const PointBatch&)>;

  virtual ~PointStream() = default;
  virtual const CloudFacts& facts() const = 0;
  /// Bounds of the local coordinates.
  virtual Box3 box() const = 0;
  /// Hands all points to `visit`, in order and from the thread that calls this; the same batches
  /// each time. Throws InputError when they can no longer be read, and what `visit` throws.
  virtual void pass(const Visit& visit) const = 0;
  /// The same with those points alone, in their order, that `frame_from_local` brings into `window`
  /// (x and y), and maybe others: all of them, where a stream cannot tell sooner which these are.
  virtual void passNear(const Eigen::Affine3d& frame_from_local, const Eigen::AlignedBox2d& window,
                        const Visit& visit) const;
};

/// The points of a cloud, which must outlive it.
class CloudStream : public PointStream {
 public:
  explicit CloudStream(const Cloud& cloud) : cloud_(cloud), facts_(factsOf(cloud)) {}
  const CloudFacts& facts() const override { return facts_; }
  Box3 box() const override { return boundingBox(cloud_); }
  void pass(const Visit& visit) const override;

 private:
  const Cloud& cloud_;
  CloudFacts facts_;
};

}  // namespace agricolmap
