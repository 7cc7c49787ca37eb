// Stands for the pictures where Cairo is not built in.
#include "agricolmap/core/error.hpp"
#include "agricolmap/report/pictures/pair_picture.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap::report {
namespace {

[[noreturn]] void refuse() {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

}  // namespace

bool canDraw() { return false; }

std::vector<std::string> pictureNames() { return {}; }

std::vector<std::string> writePictures(const io::OutputPath& /*dir*/,
                                       const pipeline::Registration& /*registration*/,
                                       const PictureInfo& /*info*/) {
  refuse();
}

void writePairPicture(const io::OutputPath& /*path*/, const Cloud& /*fixed*/,
                      const Cloud& /*moving*/, const Eigen::Affine3d& /*fixed_from_moving*/,
                      const PairPictureInfo& /*info*/) {
  refuse();
}

}  // namespace agricolmap::report
