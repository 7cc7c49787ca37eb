// Points of both clouds for the page: few enough for it, and said how few.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::report {

/// Some of a cloud's points.
struct PointSample {
  std::vector<Eigen::Vector3f> xyz;
  std::vector<Rgb> rgb;  ///< as many, or none
  std::size_t of = 0;    ///< how many there are in the window
};

/// At most `most` of the points that `frame_from_local` brings into `window`, each as likely as any
/// other; the same ones each time, whatever order they come in. One pass.
PointSample samplePoints(const PointStream& cloud, const Eigen::Affine3d& frame_from_local,
                         const Eigen::AlignedBox2d& window, std::size_t most);

/// Points in steps of a millimetre or what 16 bits allow, sorted by place, as differences, gzip,
/// base64; web/points.js reads them.
nlohmann::ordered_json packedPoints(PointSample sample);

/// Both clouds about the strip, local coordinates of the fixed cloud: the moving one where the
/// registration lays it, bends taken out; by `guess` (file coordinates) where it lays it nowhere.
/// Null in a build without pictures.
nlohmann::ordered_json pagePoints(const PointStream& fixed, const Cloud& moving,
                                  const pipeline::Registration& registration,
                                  const Eigen::Affine3d& guess);

}  // namespace agricolmap::report
