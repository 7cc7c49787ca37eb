#include <utility>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/report/page/page_assets.hpp"
#include "agricolmap/report/page/page_maps.hpp"
#include "agricolmap/report/page/page_points.hpp"
#include "agricolmap/report/page/registration_page.hpp"

namespace agricolmap::report {

nlohmann::ordered_json pageScene(const PointStream& fixed, const Cloud& moving,
                                 const pipeline::Registration& registration,
                                 const Eigen::Affine3d& guess) {
  nlohmann::ordered_json maps;
  nlohmann::ordered_json points;
  parallelFor(2, [&](std::size_t i) {
    if (i == 0) {
      maps = pageMaps(registration, fixed.facts(), moving,
                      {fixed.facts().coloured, moving.hasColour()});
    } else if (!pageScript3d().empty()) {
      points = pagePoints(fixed, moving, registration, guess);
    }
  });
  return {{"maps", std::move(maps)}, {"points", std::move(points)}};
}

}  // namespace agricolmap::report
