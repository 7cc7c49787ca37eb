// Detectors and descriptors of OpenCV and dlib, and BRIEF.
#include <dlib/image_keypoint/surf.h>
#include <dlib/opencv.h>

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "agricolmap/core/random.hpp"
#include "experiments/methods/features/features.hpp"

namespace agricolmap::experiments {
namespace {

constexpr int kMost = 10000;  // keypoints; ORB's 500 are too few for 200 m² (our choice)

// SURF: dlib's threshold of the Hessian's determinant is 30, tuned on photographs (our choice).
constexpr double kSurfThreshold = 5.0;
// The picture is enlarged beforehand, as the article does in its finest variant: leaves are a few
// cells wide, the smallest blob that the detector sees is larger (our choice).
constexpr int kSurfEnlarge = 2;

// ORB leaves out a rim of this many pixels, which would be half of a strip.
constexpr int kRim = 31;
constexpr float kOrbPyramidFactor = 1.2F;  // library default
constexpr int kOrbLevels = 8;              // library default
constexpr int kOrbThreshold = 10;          // library: 20, tuned on photographs; maps are smoother

constexpr int kFastThreshold = 10;  // library default [grey levels]

constexpr double kSiftContrast = 0.02;  // library: 0.04; maps are smoother (our choice)
constexpr double kSiftEdge = 10.0;      // library default
constexpr double kSiftSigma = 1.6;      // library default

// BRIEF, all of the article: side of the patch [pixels], the Gaussian that smooths the picture.
constexpr int kPatch = 33;
constexpr double kBriefSigma = 2.0;
constexpr int kBriefKernel = 9;
constexpr int kBriefBytes = 32;

/// The features that lie on known cells.
Features onKnownGround(const std::vector<Eigen::Vector2d>& cells, const cv::Mat& descriptors,
                       const ExgImage& image) {
  Features kept;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int col = static_cast<int>(std::lround(cells[i].x()));
    const int row = static_cast<int>(std::lround(cells[i].y()));
    const bool inside = row >= 0 && col >= 0 && row < image.known.rows && col < image.known.cols;
    if (!inside || image.known.at<std::uint8_t>(row, col) == 0) continue;
    kept.cells.push_back(cells[i]);
    kept.descriptors.push_back(descriptors.row(static_cast<int>(i)));
  }
  return kept;
}

/// Keypoints of a picture with a rim as cells of the map.
std::vector<Eigen::Vector2d> cellsOf(const std::vector<cv::KeyPoint>& keypoints, int rim) {
  std::vector<Eigen::Vector2d> cells;
  cells.reserve(keypoints.size());
  for (const cv::KeyPoint& key : keypoints) {
    cells.emplace_back(static_cast<double>(key.pt.x) - rim, static_cast<double>(key.pt.y) - rim);
  }
  return cells;
}

/// Two places around a keypoint, (col, row).
struct Comparison {
  cv::Point a;
  cv::Point b;
};
const std::vector<Comparison>& comparisons() {
  static const std::vector<Comparison> all = [] {
    Random random(1);  // the article draws them at random, too
    const auto draw = [&] {
      const int at = static_cast<int>(std::lround(random.normal(kPatch / 5.0)));
      return std::clamp(at, -kPatch / 2, kPatch / 2);
    };
    std::vector<Comparison> made(8 * kBriefBytes);
    for (Comparison& one : made) {
      do {
        one.a.y = draw();
        one.a.x = draw();
        one.b.y = draw();
        one.b.x = draw();
      } while (one.a == one.b);
    }
    return made;
  }();
  return all;
}

}  // namespace

Features surfFeatures(const ExgImage& image) {
  cv::Mat large;
  cv::resize(image.grey, large, {}, kSurfEnlarge, kSurfEnlarge, cv::INTER_LINEAR);
  const std::vector<dlib::surf_point> points =
      dlib::get_surf_points(dlib::cv_image<unsigned char>(large), kMost, kSurfThreshold);
  std::vector<Eigen::Vector2d> cells;
  cv::Mat descriptors(static_cast<int>(points.size()), 64, CV_32F);
  for (const dlib::surf_point& point : points) {
    const auto row = static_cast<int>(cells.size());
    for (int k = 0; k < 64; ++k) descriptors.at<float>(row, k) = static_cast<float>(point.des(k));
    // Pixel centres of the enlarged picture lie between those of the cells.
    cells.emplace_back((point.p.center.x() + 0.5) / kSurfEnlarge - 0.5,
                       (point.p.center.y() + 0.5) / kSurfEnlarge - 0.5);
  }
  return onKnownGround(cells, descriptors, image);
}

Features orbFeatures(const ExgImage& image) {
  cv::Mat padded;
  cv::copyMakeBorder(image.grey, padded, kRim, kRim, kRim, kRim, cv::BORDER_REFLECT_101);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  cv::ORB::create(kMost, kOrbPyramidFactor, kOrbLevels, kRim, 0, 2, cv::ORB::HARRIS_SCORE, kRim,
                  kOrbThreshold)
      ->detectAndCompute(padded, cv::noArray(), keypoints, descriptors);
  return onKnownGround(cellsOf(keypoints, kRim), descriptors, image);
}

Features siftFeatures(const ExgImage& image) {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  cv::SIFT::create(kMost, 3, kSiftContrast, kSiftEdge, kSiftSigma)
      ->detectAndCompute(image.grey, cv::noArray(), keypoints, descriptors);
  return onKnownGround(cellsOf(keypoints, 0), descriptors, image);
}

Features fastBriefFeatures(const ExgImage& image) {
  std::vector<cv::KeyPoint> keypoints;
  cv::FAST(image.grey, keypoints, kFastThreshold, true);
  std::stable_sort(
      keypoints.begin(), keypoints.end(),
      [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
  if (keypoints.size() > kMost) keypoints.resize(kMost);
  const std::vector<Eigen::Vector2d> cells = cellsOf(keypoints, 0);
  return onKnownGround(cells, briefOf(image.grey, cells), image);
}

cv::Mat briefOf(const cv::Mat& grey, const std::vector<Eigen::Vector2d>& cells) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {kBriefKernel, kBriefKernel}, kBriefSigma, kBriefSigma,
                   cv::BORDER_REPLICATE);
  cv::Mat descriptors = cv::Mat::zeros(static_cast<int>(cells.size()), kBriefBytes, CV_8U);
  for (int i = 0; i < descriptors.rows; ++i) {
    const Eigen::Vector2d& cell = cells[static_cast<std::size_t>(i)];
    const cv::Point centre(static_cast<int>(std::lround(cell.x())),
                           static_cast<int>(std::lround(cell.y())));
    const auto at = [&](const cv::Point& offset) {
      return smooth.at<std::uint8_t>(std::clamp(centre.y + offset.y, 0, smooth.rows - 1),
                                     std::clamp(centre.x + offset.x, 0, smooth.cols - 1));
    };
    for (std::size_t k = 0; k < comparisons().size(); ++k) {
      if (at(comparisons()[k].a) >= at(comparisons()[k].b)) continue;
      auto& byte = descriptors.at<std::uint8_t>(i, static_cast<int>(k / 8));
      byte = static_cast<std::uint8_t>(byte | (1U << (k % 8)));
    }
  }
  return descriptors;
}

}  // namespace agricolmap::experiments
