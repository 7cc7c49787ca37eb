// Stands for the picture where Cairo is not built in.
#include "agricolmap/core/error.hpp"
#include "agricolmap/simulate/picture/pair_picture.hpp"

namespace agricolmap::simulate {

void writePairPicture(const io::OutputPath& /*path*/, const Cloud& /*fixed*/,
                      const Cloud& /*moving*/, const Eigen::Affine3d& /*fixed_from_moving*/,
                      const PairPictureInfo& /*info*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

}  // namespace agricolmap::simulate
