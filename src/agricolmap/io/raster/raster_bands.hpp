// What the bands of a raster are, by what the file says of them and by their values.
#pragma once

#include <gdal_priv.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/io/raster/raster_file.hpp"

namespace agricolmap::io {

using ColourBands = std::array<GDALRasterBand*, 3>;  ///< red, green, blue

/// By `order`; kAuto: by the bands' names, else by the colours that the file declares, else the
/// first three where there are at most four. Throws InputError when there are no such bands.
ColourBands colourBandsOf(GDALDataset& dataset, BandOrder order, const std::string& name);

/// The band that the file calls transparency, unless its name says otherwise.
GDALRasterBand* alphaBandOf(GDALDataset& dataset);

/// From the values of such a band: 0 where they take a pixel away, below half of the largest of
/// them; nothing where they are data rather than transparency: neither nearly none nor nearly all
/// at most pixels.
std::optional<Raster<std::uint8_t>> maskFromAlpha(const Raster<float>& alpha);

/// Metres per unit of the heights in a band: by its unit, else by a vertical coordinate system,
/// else metres; that of x and y where these are others, which is a warning. Throws InputError when
/// the unit is not known.
double heightUnitOf(GDALDataset& dataset, GDALRasterBand& band, const std::string& name,
                    std::vector<std::string>& warnings);

/// Throws InputError when the values are no heights: of a picture or hillshade.
void refusePictureAsHeights(GDALDataset& dataset, const Raster<float>& values,
                            const std::string& name);

}  // namespace agricolmap::io
