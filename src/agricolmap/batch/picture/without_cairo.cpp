// Stands for the picture where Cairo is not built in.
#include "agricolmap/batch/picture/summary_picture.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {

void writeSummaryPicture(const io::OutputPath& /*path*/, std::span<const MapGround> /*grounds*/,
                         std::span<const Record> /*records*/) {
  throw UsageError("pictures need Cairo, and this build has none (AGRICOLMAP_WITH_PICTURES)");
}

}  // namespace agricolmap::batch
