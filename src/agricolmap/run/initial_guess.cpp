#include "agricolmap/run/initial_guess.hpp"

#include <fmt/format.h>

#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"

namespace agricolmap::run {

Eigen::Affine3d initialGuess(const std::filesystem::path& fixed,
                             const std::filesystem::path& moving, const std::string& prior_file,
                             std::string& source, const Say& say) {
  if (!prior_file.empty()) {
    source = prior_file;
    return io::readMatrix(prior_file);
  }
  const auto world_from_fixed = io::readOffsetBeside(fixed);
  const auto world_from_moving = io::readOffsetBeside(moving);
  for (const std::filesystem::path& cloud : {fixed, moving}) {
    for (const std::string& file : io::offsetsPassedBy(cloud)) {
      say({fmt::format(
          "{} is passed by: were it the offset of {}, it would be called {}.offset.xyz", file,
          cloud.string(), cloud.stem().string())});
    }
  }
  if (!world_from_fixed && !world_from_moving) {
    source = "coordinates as they stand";
    return Eigen::Affine3d::Identity();
  }
  source = "offset.xyz";
  const Eigen::Affine3d identity = Eigen::Affine3d::Identity();
  if (!world_from_fixed || !world_from_moving) {
    say({fmt::format("only {} has an offset.xyz; {} is taken to be in world coordinates already",
                     (world_from_fixed ? fixed : moving).string(),
                     (world_from_fixed ? moving : fixed).string())});
    source = "offset.xyz of one cloud";
  }
  return world_from_fixed.value_or(identity).inverse(Eigen::Isometry) *
         world_from_moving.value_or(identity);
}

}  // namespace agricolmap::run
