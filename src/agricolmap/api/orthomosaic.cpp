#include "agricolmap/core/processor.hpp"
#include "agricolmap/io.hpp"
#include "agricolmap/io/raster/raster_import.hpp"

namespace agricolmap {

Cloud readOrthomosaic(const std::filesystem::path& ortho,
                      const std::filesystem::path& surface_model) {
  requireProcessor();
  return io::importOrthoDsm(ortho, surface_model);
}

}  // namespace agricolmap
