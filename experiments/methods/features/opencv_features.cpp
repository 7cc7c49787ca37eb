#include "experiments/methods/features/opencv_features.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <utility>

namespace agricolmap::experiments {
namespace {

/// ORB leaves out a rim of this many pixels, which would be half of a strip.
constexpr int kRim = 31;

/// The picture with `rim` mirrored pixels around it.
cv::Mat pictureOf(const ExgImage& image, int rim) {
  cv::Mat picture(image.grey.rows(), image.grey.cols(), CV_8U);
  for (int r = 0; r < picture.rows; ++r) {
    std::copy_n(image.grey.row(r), picture.cols, picture.ptr<std::uint8_t>(r));
  }
  cv::Mat padded;
  cv::copyMakeBorder(picture, padded, rim, rim, rim, rim, cv::BORDER_REFLECT_101);
  return padded;
}

/// Keypoints of the picture with the rim as cells of the map.
std::vector<Eigen::Vector2d> cellsOf(const std::vector<cv::KeyPoint>& keypoints, int rim) {
  std::vector<Eigen::Vector2d> cells;
  cells.reserve(keypoints.size());
  for (const cv::KeyPoint& key : keypoints) {
    cells.emplace_back(static_cast<double>(key.pt.x) - rim, static_cast<double>(key.pt.y) - rim);
  }
  return cells;
}

class Orb : public FeatureExtractor {
 public:
  explicit Orb(const OrbOptions& options) : options_(options) {}
  std::string name() const override { return "orb"; }
  Features extract(const ExgImage& image) const override {
    const cv::Mat picture = pictureOf(image, kRim);
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    cv::ORB::create(options_.most, static_cast<float>(options_.pyramid_factor), options_.levels,
                    kRim, 0, 2, cv::ORB::HARRIS_SCORE, kRim, options_.fast_threshold)
        ->detectAndCompute(picture, cv::noArray(), keypoints, descriptors);
    Features features;
    features.cells = cellsOf(keypoints, kRim);
    features.bytes = 32;
    for (int i = 0; i < descriptors.rows; ++i) {
      const auto* bits = descriptors.ptr<std::uint8_t>(i);
      features.bits.insert(features.bits.end(), bits, bits + features.bytes);
    }
    return onKnownGround(features, image);
  }

 private:
  OrbOptions options_;
};

class FastBrief : public FeatureExtractor {
 public:
  explicit FastBrief(const FastBriefOptions& options) : options_(options), brief_(options.brief) {}
  std::string name() const override { return "fast-brief"; }
  Features extract(const ExgImage& image) const override {
    const cv::Mat picture = pictureOf(image, 0);
    std::vector<cv::KeyPoint> keypoints;
    cv::FAST(picture, keypoints, options_.threshold, true);
    std::stable_sort(
        keypoints.begin(), keypoints.end(),
        [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
    if (keypoints.size() > static_cast<std::size_t>(options_.most)) {
      keypoints.resize(static_cast<std::size_t>(options_.most));
    }
    const Raster<std::uint8_t> smooth = brief_.smoothed(image.grey);
    Features features;
    features.cells = cellsOf(keypoints, 0);
    features.bytes = Brief::kBytes;
    for (const Eigen::Vector2d& cell : features.cells) {
      const auto bits = brief_.describe(smooth, static_cast<int>(std::lround(cell.y())),
                                        static_cast<int>(std::lround(cell.x())));
      features.bits.insert(features.bits.end(), bits.begin(), bits.end());
    }
    return onKnownGround(features, image);
  }

 private:
  FastBriefOptions options_;
  Brief brief_;
};

class Sift : public FeatureExtractor {
 public:
  explicit Sift(const SiftOptions& options) : options_(options) {}
  std::string name() const override { return "sift"; }
  Features extract(const ExgImage& image) const override {
    const cv::Mat picture = pictureOf(image, 0);
    std::vector<cv::KeyPoint> keypoints;
    cv::Mat descriptors;
    cv::SIFT::create(options_.most, 3, options_.contrast, options_.edge, options_.sigma)
        ->detectAndCompute(picture, cv::noArray(), keypoints, descriptors);
    Features features;
    features.cells = cellsOf(keypoints, 0);
    features.real.resize(descriptors.cols, descriptors.rows);
    for (int i = 0; i < descriptors.rows; ++i) {
      for (int k = 0; k < descriptors.cols; ++k) features.real(k, i) = descriptors.at<float>(i, k);
    }
    return onKnownGround(features, image);
  }

 private:
  SiftOptions options_;
};

}  // namespace

std::unique_ptr<FeatureExtractor> makeOrb(const OrbOptions& options) {
  return std::make_unique<Orb>(options);
}

std::unique_ptr<FeatureExtractor> makeFastBrief(const FastBriefOptions& options) {
  return std::make_unique<FastBrief>(options);
}

std::unique_ptr<FeatureExtractor> makeSift(const SiftOptions& options) {
  return std::make_unique<Sift>(options);
}

}  // namespace agricolmap::experiments
