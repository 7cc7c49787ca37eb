#include "experiments/methods/features/surf_features.hpp"

#include <dlib/array2d.h>
#include <dlib/image_keypoint/surf.h>

#include <algorithm>
#include <cmath>

namespace agricolmap::experiments {
namespace {

/// The picture `factor` times as large, bilinear.
dlib::array2d<unsigned char> enlarged(const Raster<std::uint8_t>& grey, int factor) {
  dlib::array2d<unsigned char> large(static_cast<long>(grey.rows()) * factor,
                                     static_cast<long>(grey.cols()) * factor);
  for (long r = 0; r < large.nr(); ++r) {
    for (long c = 0; c < large.nc(); ++c) {
      const double y =
          std::clamp((static_cast<double>(r) + 0.5) / factor - 0.5, 0.0, grey.rows() - 1.0);
      const double x =
          std::clamp((static_cast<double>(c) + 0.5) / factor - 0.5, 0.0, grey.cols() - 1.0);
      const int row = std::min(static_cast<int>(y), std::max(0, grey.rows() - 2));
      const int col = std::min(static_cast<int>(x), std::max(0, grey.cols() - 2));
      const int below = std::min(row + 1, grey.rows() - 1);
      const int beside = std::min(col + 1, grey.cols() - 1);
      const double u = x - col;
      const double v = y - row;
      const double value = (1.0 - v) * ((1.0 - u) * grey(row, col) + u * grey(row, beside)) +
                           v * ((1.0 - u) * grey(below, col) + u * grey(below, beside));
      large[r][c] = static_cast<unsigned char>(std::lround(value));
    }
  }
  return large;
}

class Surf : public FeatureExtractor {
 public:
  explicit Surf(const SurfOptions& options) : options_(options) {}
  std::string name() const override { return "surf"; }
  Features extract(const ExgImage& image) const override {
    const dlib::array2d<unsigned char> picture = enlarged(image.grey, options_.enlarge);
    const std::vector<dlib::surf_point> points =
        dlib::get_surf_points(picture, options_.most, options_.threshold);
    Features features;
    features.real.resize(64, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const dlib::surf_point& point = points[i];
      // Pixel centres of the enlarged picture lie between those of the cells.
      features.cells.emplace_back((point.p.center.x() + 0.5) / options_.enlarge - 0.5,
                                  (point.p.center.y() + 0.5) / options_.enlarge - 0.5);
      for (int k = 0; k < 64; ++k) {
        features.real(k, static_cast<Eigen::Index>(i)) = static_cast<float>(point.des(k));
      }
    }
    return onKnownGround(features, image);
  }

 private:
  SurfOptions options_;
};

}  // namespace

std::unique_ptr<FeatureExtractor> makeSurf(const SurfOptions& options) {
  return std::make_unique<Surf>(options);
}

}  // namespace agricolmap::experiments
