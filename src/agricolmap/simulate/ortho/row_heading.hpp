// The direction of the plant rows in an orthomosaic.
#pragma once

#include "agricolmap/simulate/ortho/ortho.hpp"

namespace agricolmap::simulate {

/// Rows make sums of greenness along them differ most from line to line: the direction whose sums
/// over 3 cm wide lines explain the largest share of the variance of Excess Green, without what is
/// coarser than about a metre, in a disc around the middle of the data. [rad], -π/2 … π/2 from the
/// raster's x axis. Throws InputError when no direction stands out: no rows, or a closed canopy.
double findRowHeading(const OrthoField& field);

}  // namespace agricolmap::simulate
