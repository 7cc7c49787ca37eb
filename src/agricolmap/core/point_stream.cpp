#include "agricolmap/core/point_stream.hpp"

#include <algorithm>

namespace agricolmap {

CloudFacts factsOf(const Cloud& cloud) {
  CloudFacts facts;
  facts.name = cloud.name;
  facts.origin = cloud.origin;
  facts.points = cloud.size();
  facts.coloured = cloud.hasColour();
  facts.dropped_points = cloud.dropped_points;
  facts.warnings = cloud.warnings;
  facts.crs = cloud.crs;
  facts.fields = cloud.fields;
  return facts;
}

void PointStream::passNear(const Eigen::Affine3d& /*frame_from_local*/,
                           const Eigen::AlignedBox2d& /*window*/, const Visit& visit) const {
  pass(visit);
}

void CloudStream::pass(const Visit& visit) const {
  const std::span<const Eigen::Vector3f> xyz(cloud_.xyz);
  const std::span<const Rgb> rgb(cloud_.rgb);
  for (std::size_t first = 0; first < xyz.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, xyz.size() - first);
    PointBatch batch{xyz.subspan(first, count), {}, first};
    if (!rgb.empty()) batch.rgb = rgb.subspan(first, count);
    visit(batch);
  }
}

}  // namespace agricolmap
