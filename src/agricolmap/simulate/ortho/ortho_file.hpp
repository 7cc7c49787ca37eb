// Orthomosaics from files, laid out as the simulator wants them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "agricolmap/core/options.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/simulate/ortho/ortho.hpp"

namespace agricolmap::simulate {

/// What shows one field. Paths other than `ortho` may be empty.
struct OrthoFiles {
  std::filesystem::path ortho;  ///< colours: any picture that GDAL reads
  std::filesystem::path dsm;    ///< surface model; needs a georeferenced `ortho`
  std::filesystem::path dtm;    ///< terrain model; needs `dsm`
};

struct OrthoFileOptions {
  io::RasterOptions raster;
  double gsd = 0.0;  ///< size of a pixel [m]; 0: as the georeference says
};
void listOptions(OptionTable& table, OrthoFileOptions& options);

/// The part of the mosaic, at most `width` × `height` metres, that `seed` chooses: around a
/// random green pixel, with data in nearly all of it or, where no such part is found, the fullest
/// of those tried. Looks at a thumbnail only. Throws InputError as readOrtho does.
io::PixelWindow chooseWindow(const std::filesystem::path& ortho, const OrthoFileOptions& options,
                             double width, double height, std::uint64_t seed);

/// Reads the field, or a window of the mosaic. Pixels become square; heights may have any
/// resolution, extent and rotation and are interpolated. Where a model has no height, the field has
/// no data. `row_heading` is left at 0.
///
/// Throws InputError when a file cannot be read, the mosaic has neither georeference nor
/// `options.gsd` or both and they differ, is not north up, not in metres, too coarse to show plants
/// or too large for memory, or a model does not overlap it; UsageError for a model without what it
/// needs.
OrthoField readOrtho(const OrthoFiles& files, const OrthoFileOptions& options = {},
                     const std::optional<io::PixelWindow>& window = {});

}  // namespace agricolmap::simulate
