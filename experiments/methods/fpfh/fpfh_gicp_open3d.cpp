#include "experiments/methods/fpfh/fpfh_gicp_open3d.hpp"

#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/FastGlobalRegistration.h>
#include <open3d/pipelines/registration/Feature.h>
#include <open3d/pipelines/registration/GeneralizedICP.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/utility/Logging.h>
#include <open3d/utility/Random.h>

#include <chrono>
#include <exception>
#include <memory>
#include <vector>

// Of OpenMP. Not by <omp.h>: every compiler has its own, and clang-tidy's need not be installed.
extern "C" {
int omp_get_max_threads();
void omp_set_num_threads(int threads);
}

namespace agricolmap::experiments {
namespace {

namespace o3d = open3d::pipelines::registration;
using open3d::geometry::KDTreeSearchParamHybrid;
using open3d::geometry::PointCloud;

// Side of the cubes that points are merged to for the features [m]; the tutorial has 5 cm, for a
// room. Our choice: features then reach half a metre, to the next plants and rows, in seconds.
constexpr double kVoxel = 0.10;
// And for the refinement [m], which the tutorial, too, does on finer points.
constexpr double kFineVoxel = 0.05;
constexpr double kNormalRadius = 2.0;    // [voxels]; tutorial
constexpr int kNormalNeighbours = 30;    // tutorial
constexpr double kFeatureRadius = 5.0;   // [voxels]; tutorial
constexpr int kFeatureNeighbours = 100;  // tutorial
constexpr double kFgrDistance = 0.5;     // of a correspondence [voxels]; tutorial
constexpr int kFgrIterations = 64;       // library default
constexpr int kFgrTuples = 1000;         // library default
// Of pairs of the refinement [fine voxels]. The tutorial has 0.4, after a rougher ICP: a room's
// walls forgive what plants do not (our choice).
constexpr double kGicpDistance = 1.5;
constexpr int kGicpIterations = 100;  // library: 30, not always enough (our choice)
constexpr int kSeed = 1;              // of the draw of tuples
constexpr std::size_t kLeast = 100;   // points in a cloud

class Timer {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// One thread for as long as it lives: sums depend on their number.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

std::shared_ptr<PointCloud> thinned(const PlainPoints& points, double voxel) {
  PointCloud cloud;
  cloud.points_.reserve(points.size());
  for (const auto& point : points) cloud.points_.emplace_back(point[0], point[1], point[2]);
  std::shared_ptr<PointCloud> thin = cloud.VoxelDownSample(voxel);
  thin->EstimateNormals(KDTreeSearchParamHybrid(kNormalRadius * voxel, kNormalNeighbours));
  // Fields are seen from above.
  thin->OrientNormalsToAlignWithDirection(Eigen::Vector3d::UnitZ());
  return thin;
}

void registerInto(FpfhGicpResult& result, const PlainPoints& fixed_points,
                  const PlainPoints& moving_points) {
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  const Timer features;
  const std::shared_ptr<PointCloud> fixed = thinned(fixed_points, kVoxel);
  const std::shared_ptr<PointCloud> moving = thinned(moving_points, kVoxel);
  const KDTreeSearchParamHybrid around(kFeatureRadius * kVoxel, kFeatureNeighbours);
  const auto fixed_features = o3d::ComputeFPFHFeature(*fixed, around);
  const auto moving_features = o3d::ComputeFPFHFeature(*moving, around);
  const std::shared_ptr<PointCloud> fine_fixed = thinned(fixed_points, kFineVoxel);
  const std::shared_ptr<PointCloud> fine_moving = thinned(moving_points, kFineVoxel);
  result.features_s = features.seconds();
  const OneThread one;
  const Timer matching;
  open3d::utility::random::Seed(kSeed);
  o3d::FastGlobalRegistrationOption option;
  option.maximum_correspondence_distance_ = kFgrDistance * kVoxel;
  option.iteration_number_ = kFgrIterations;
  option.maximum_tuple_count_ = kFgrTuples;
  const o3d::RegistrationResult global = o3d::FastGlobalRegistrationBasedOnFeatureMatching(
      *moving, *fixed, *moving_features, *fixed_features, option);
  result.global_s = matching.seconds();
  const Timer refining;
  const std::vector<Eigen::Matrix4d> starts = {Eigen::Matrix4d::Identity(),
                                               Eigen::Matrix4d(global.transformation_)};
  double least_rmse = 0.0;
  for (const Eigen::Matrix4d& start : starts) {
    const o3d::RegistrationResult refined =
        o3d::RegistrationGeneralizedICP(*fine_moving, *fine_fixed, kGicpDistance * kFineVoxel,
                                        start, o3d::TransformationEstimationForGeneralizedICP(),
                                        o3d::ICPConvergenceCriteria(1e-6, 1e-6, kGicpIterations));
    if (!(refined.fitness_ > 0.0)) continue;
    // Whatever lies on the field's ground has neighbours: the one that fits closer is taken.
    if (result.found && refined.inlier_rmse_ >= least_rmse) continue;
    result.found = true;
    least_rmse = refined.inlier_rmse_;
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) {
        result.transform[static_cast<std::size_t>(4 * r + c)] = refined.transformation_(r, c);
      }
    }
  }
  result.gicp_s = refining.seconds();
  if (!result.found) result.why = "no moving point has a fixed one near";
}

}  // namespace

FpfhGicpResult registerByFpfhGicp(const PlainPoints& fixed, const PlainPoints& moving) {
  FpfhGicpResult result;
  if (fixed.size() < kLeast || moving.size() < kLeast) {
    result.why = "fewer than 100 points in one of the clouds";
    return result;
  }
  try {
    registerInto(result, fixed, moving);
  } catch (const std::exception& error) {
    // The library throws plain runtime errors for clouds that it cannot use.
    result.found = false;
    result.why = error.what();
  }
  return result;
}

}  // namespace agricolmap::experiments
