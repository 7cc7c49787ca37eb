#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/page/page_maps.hpp"
#include "agricolmap/report/page/page_points.hpp"
#include "agricolmap/report/page/registration_page.hpp"

namespace agricolmap::report {

nlohmann::ordered_json pageScene(const PointStream& fixed, const Cloud& moving,
                                 const pipeline::Registration& registration,
                                 const Eigen::Affine3d& guess) {
  nlohmann::ordered_json json;
  json["maps"] =
      pageMaps(registration, fixed.facts(), moving, {fixed.facts().coloured, moving.hasColour()});
  json["points"] = pagePoints(fixed, moving, registration, guess);
  return json;
}

}  // namespace agricolmap::report
