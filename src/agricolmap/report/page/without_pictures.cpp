// Stands for the maps and points of a page where libpng and its zlib are not built in.
#include "agricolmap/report/page/change_page.hpp"
#include "agricolmap/report/page/facts_page.hpp"
#include "agricolmap/report/page/registration_page.hpp"
#include "agricolmap/report/page/shared_map_page.hpp"

namespace agricolmap::report {

nlohmann::ordered_json pageScene(const PointStream& /*fixed*/, const Cloud& /*moving*/,
                                 const pipeline::Registration& /*registration*/,
                                 const Eigen::Affine3d& /*guess*/) {
  return nullptr;
}

nlohmann::ordered_json sharedMapScene(const fuse::SharedMap& /*map*/) { return nullptr; }

void addFactsPictures(nlohmann::ordered_json& /*scene*/, const FactsGround& /*ground*/) {}

void addChangePictures(nlohmann::ordered_json& /*scene*/, const ChangeGround& /*ground*/) {}

}  // namespace agricolmap::report
