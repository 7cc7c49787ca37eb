#include "experiments/pairs/slip.hpp"

#include <cmath>
#include <utility>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/hash.hpp"

namespace agricolmap::experiments {
namespace {

/// An end of the strip that is displaced.
struct End {
  double sign;  ///< of its direction from the middle, in that of travel
  Eigen::Vector3f in_file;
};

}  // namespace

std::vector<Eigen::Vector3d> displacePart(simulate::SimulatedStrip& strip, const Slip& slip,
                                          const simulate::SimulationOptions& options) {
  Random random = Random::stream(static_cast<std::uint64_t>(options.seed),
                                 hashText(slip.along ? "slip along" : "slip across"));
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  const Eigen::Vector3d ahead(std::cos(strip.strip_heading), std::sin(strip.strip_heading), 0.0);
  const Eigen::Vector3d across(-ahead.y(), ahead.x(), 0.0);
  const auto endOf = [&](double end, const Eigen::Vector3d& direction) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const Eigen::Vector3d shift = side * slip.metres * direction;
    return End{end, (strip.nominal.linear().inverse() * shift).cast<float>()};
  };
  std::vector<End> ends = {endOf(sign, slip.along ? ahead : across)};
  if (slip.twice) ends.push_back(endOf(-sign, slip.along ? across : ahead));
  const double begin = (0.5 - slip.share) * options.ugv.length;
  Cloud larger;
  larger.origin = strip.ugv.origin;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < strip.truth.size(); ++i) {
    bool displaced = false;
    for (const End& end : ends) {
      if (end.sign * ahead.dot(strip.truth[i] - strip.strip_centre) <= begin) continue;
      strip.ugv.xyz[i] += end.in_file;
      displaced = true;
    }
    if (displaced) continue;
    larger.xyz.push_back(strip.ugv.xyz[i]);
    truth.push_back(strip.truth[i]);
  }
  strip.best_affine = fitAffine(larger, truth);
  std::vector<Eigen::Vector3d> places;
  for (const End& end : ends) {
    places.emplace_back(strip.strip_centre + end.sign * begin * ahead);
  }
  return places;
}

}  // namespace agricolmap::experiments
