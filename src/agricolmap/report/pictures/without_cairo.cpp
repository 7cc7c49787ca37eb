// Stands for the pictures where Cairo is not built in.
#include "agricolmap/core/error.hpp"
#include "agricolmap/report/pictures/change_picture.hpp"
#include "agricolmap/report/pictures/facts_picture.hpp"
#include "agricolmap/report/pictures/pictures.hpp"
#include "agricolmap/report/pictures/prescription_picture.hpp"
#include "agricolmap/report/pictures/shared_map_picture.hpp"

namespace agricolmap::report {

bool canDraw() { return false; }

std::vector<std::string> pictureNames() { return {}; }

std::vector<std::string> writePictures(const io::OutputPath& /*dir*/,
                                       const pipeline::Registration& /*registration*/,
                                       const PictureInfo& /*info*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

void writeSharedMapPicture(const io::OutputPath& /*path*/, const fuse::SharedMap& /*map*/,
                           const std::vector<const PointStream*>& /*points*/,
                           const std::string& /*name*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

void writeChangePicture(const io::OutputPath& /*path*/, const ChangeScene& /*scene*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

void writeFactsPicture(const io::OutputPath& /*path*/, const GridFrame& /*frame*/,
                       const PlacedFacts& /*placed*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

void writePrescriptionPicture(const io::OutputPath& /*path*/, const PrescriptionScene& /*scene*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

}  // namespace agricolmap::report
