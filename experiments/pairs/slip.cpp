#include "experiments/pairs/slip.hpp"

#include <cmath>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/hash.hpp"

namespace agricolmap::experiments {

void displacePart(simulate::SimulatedStrip& strip, const Slip& slip,
                  const simulate::SimulationOptions& options) {
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed),
                                 hashText(slip.along ? "slip along" : "slip across"));
  const double end = random.chance(0.5) ? 1.0 : -1.0;
  const double side = random.chance(0.5) ? 1.0 : -1.0;
  const Eigen::Vector3d ahead(std::cos(strip.strip_heading), std::sin(strip.strip_heading), 0.0);
  const Eigen::Vector3d across(-ahead.y(), ahead.x(), 0.0);
  const Eigen::Vector3d shift = side * slip.metres * (slip.along ? ahead : across);
  const Eigen::Vector3f in_file = (strip.nominal.linear().inverse() * shift).cast<float>();
  const double begin = (0.5 - slip.share) * options.ugv.length;
  Cloud larger;
  larger.origin = strip.ugv.origin;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < strip.truth.size(); ++i) {
    if (end * ahead.dot(strip.truth[i] - strip.strip_centre) > begin) {
      strip.ugv.xyz[i] += in_file;
    } else {
      larger.xyz.push_back(strip.ugv.xyz[i]);
      truth.push_back(strip.truth[i]);
    }
  }
  strip.best_affine = fitAffine(larger, truth);
}

}  // namespace agricolmap::experiments
