// What a registration leaves for its report and pictures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

struct Registration::Record {
  pipeline::Registration found;
  verdict::EvidenceOptions evidence;  ///< those it was judged with
  std::string fixed_name;
  std::string moving_name;
  Eigen::Vector3d fixed_origin = Eigen::Vector3d::Zero();  ///< of its local coordinates [m]
  Crs fixed_crs;
  bool fixed_coloured = false;
  bool moving_coloured = false;
  nlohmann::ordered_json report;  ///< but for the names of the pictures
};

}  // namespace agricolmap
