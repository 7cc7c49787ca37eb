// Mutual nearest neighbours among the descriptors, looked for exhaustively where the guess allows.
#include <cmath>
#include <limits>
#include <opencv2/core/hal/hal.hpp>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/paper/flow/reach.hpp"
#include "experiments/methods/features/features.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

float distance(const cv::Mat& a, std::size_t i, const cv::Mat& b, std::size_t j) {
  const int row_a = static_cast<int>(i);
  const int row_b = static_cast<int>(j);
  if (a.type() == CV_8U) {
    return static_cast<float>(cv::hal::normHamming(a.ptr(row_a), b.ptr(row_b), a.cols));
  }
  return std::sqrt(cv::hal::normL2Sqr_(a.ptr<float>(row_a), b.ptr<float>(row_b), a.cols));
}

/// The nearest and the second nearest distance.
struct Nearest {
  std::uint32_t index = kNone;
  float first = std::numeric_limits<float>::max();
  float second = std::numeric_limits<float>::max();
  void offer(std::size_t i, float d) {
    if (d < first) {
      second = first;
      first = d;
      index = static_cast<std::uint32_t>(i);
    } else if (d < second) {
      second = d;
    }
  }
};

std::vector<Eigen::Vector2d> placesOf(const Features& features, const GridFrame& frame) {
  std::vector<Eigen::Vector2d> places;
  places.reserve(features.size());
  for (const Eigen::Vector2d& cell : features.cells) {
    places.push_back(frame.centre(cell.y(), cell.x()));
  }
  return places;
}

}  // namespace

std::vector<Match> matchFeatures(const Features& fixed, const GridFrame& fixed_frame,
                                 const Features& moving, const GridFrame& moving_frame,
                                 const SearchSpace& space, double ratio) {
  const std::vector<Eigen::Vector2d> fixed_at = placesOf(fixed, fixed_frame);
  const std::vector<Eigen::Vector2d> moving_at = placesOf(moving, moving_frame);
  const paper::Reach reach(space);
  std::vector<map::Box2> boxes(moving.size());
  std::vector<Nearest> forward(moving.size());
  parallelFor(
      moving.size(),
      [&](std::size_t i) {
        boxes[i] = reach.forwardBox(moving_at[i]);
        for (std::size_t j = 0; j < fixed.size(); ++j) {
          if (boxes[i].contains(fixed_at[j]))
            forward[i].offer(j, distance(fixed.descriptors, j, moving.descriptors, i));
        }
      },
      16);
  std::vector<Nearest> backward(fixed.size());
  parallelFor(
      fixed.size(),
      [&](std::size_t j) {
        for (std::size_t i = 0; i < moving.size(); ++i) {
          if (boxes[i].contains(fixed_at[j]))
            backward[j].offer(i, distance(fixed.descriptors, j, moving.descriptors, i));
        }
      },
      16);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Nearest& best = forward[i];
    if (best.index == kNone || backward[best.index].index != i) continue;
    if (ratio < 1.0 && static_cast<double>(best.first) > ratio * static_cast<double>(best.second)) {
      continue;
    }
    matches.push_back({moving_at[i], fixed_at[best.index]});
  }
  return matches;
}

}  // namespace agricolmap::experiments
