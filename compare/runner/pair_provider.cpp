#include "runner/pair_provider.hpp"

#include <fmt/format.h>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"

namespace agricolmap::compare {
namespace {

/// A truth the wrong way round, or one that counts from other coordinates than the files', would
/// make every method look wrong.
void checkTruth(const PublishedPair& pair, const Cloud& fixed, const Cloud& moving,
                const Eigen::Affine3d& truth) {
  const Box3 box = boundingBox(fixed);
  const Eigen::Vector2d middle =
      (truth * (moving.origin + meanPoint(moving)) - fixed.origin).head<2>();
  const Eigen::Vector2d low = box.min.head<2>().cast<double>();
  const Eigen::Vector2d high = box.max.head<2>().cast<double>();
  if ((middle.array() >= low.array()).all() && (middle.array() <= high.array()).all()) return;
  const Eigen::Vector2d place = fixed.origin.head<2>() + middle;
  const Eigen::Vector2d from = fixed.origin.head<2>() + low;
  const Eigen::Vector2d to = fixed.origin.head<2>() + high;
  throw InputError(fmt::format(
      "{}: lays the row's middle at x {:.2f}, y {:.2f}, beside the drone's map (x {:.2f} "
      "to {:.2f}, y {:.2f} to {:.2f}); it must take coordinates of {} to those of {}",
      pair.truth_file->string(), place.x(), place.y(), from.x(), to.x(), from.y(), to.y(),
      pair.moving_cloud.string(), pair.fixed_cloud.string()));
}

Cloud readUsable(const std::filesystem::path& path) {
  Cloud cloud = io::readCloud(path);
  if (cloud.empty()) throw InputError(fmt::format("{}: has no usable point", path.string()));
  return cloud;
}

}  // namespace

std::string PairProvider::unavailable(const DataSet& data) const {
  if (!data.published) return maker_.unavailable(data.pairs.source);
  if (data.published->true_fixed_from_moving) return {};
  return fmt::format("{} has no truth; `agricolmap control-points` makes one",
                     data.published->moving_cloud.parent_path().string());
}

campaign::CampaignPair PairProvider::make(const DataSet& data, int seed) {
  return data.published ? read(*data.published) : maker_.make(data.pairs, seed);
}

campaign::CampaignPair PairProvider::read(const PublishedPair& pair) {
  if (fixed_file_ != pair.fixed_cloud) {
    // The old cloud goes before the new one is read.
    fixed_file_.clear();
    fixed_.reset();
    fixed_ = std::make_shared<const Cloud>(readUsable(pair.fixed_cloud));
    fixed_file_ = pair.fixed_cloud;
  }
  campaign::CampaignPair made;
  made.fixed = fixed_;
  made.moving = readUsable(pair.moving_cloud);
  made.prior = made.truth.best_affine = pair.true_fixed_from_moving.value();
  checkTruth(pair, *fixed_, made.moving, made.prior);
  return made;
}

}  // namespace agricolmap::compare
