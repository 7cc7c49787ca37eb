// What a registration leaves for its report and pictures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

struct Registration::Record {
  pipeline::Registration found;
  std::string fixed_name;
  std::string moving_name;
  pipeline::RegistrationOptions options;  ///< in force
  std::string preset;
  Transform guess = Transform::Identity();
  Eigen::Vector3d fixed_origin = Eigen::Vector3d::Zero();  ///< of its local coordinates [m]
  Eigen::Vector3d moving_origin = Eigen::Vector3d::Zero();
  std::size_t fixed_points = 0;
  std::size_t moving_points = 0;
  Crs fixed_crs;
  bool fixed_coloured = false;
  bool moving_coloured = false;
  nlohmann::ordered_json report;  ///< but for the names of the pictures
};

}  // namespace agricolmap
