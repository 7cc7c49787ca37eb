// What `agricolmap prescribe` makes rates of: a layer of a map, a raster, or the squares of facts.
#pragma once

#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap {

struct PrescribeInput {
  GridFrame frame;  ///< in file coordinates [m]
  Raster<float> values;
  Crs crs;            ///< never empty
  std::string layer;  ///< what it is called
  std::string unit;   ///< of the values; empty where they have none
};

/// `source`: a map's folder and the layer's name in it; the folder of `facts` and a field of its
/// squares; or a raster, whose band of that name, or only one, is taken. `crs`: of a source that
/// says none. `least_seen`: share of a square of facts that these must have seen. Throws InputError
/// when there is no such layer, with those that there are; when it stands for no quantity; or when
/// it lies nowhere on Earth.
PrescribeInput readPrescribeInput(const std::string& source, const std::string& layer,
                                  const std::string& crs, double least_seen);

}  // namespace agricolmap
