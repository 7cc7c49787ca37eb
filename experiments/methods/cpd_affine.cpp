#include "experiments/methods/cpd_affine.hpp"

#include <fmt/format.h>

#include "experiments/methods/peer_maps.hpp"

namespace agricolmap::experiments {
namespace {

class CpdAffine : public Method {
 public:
  explicit CpdAffine(const paper::CpdOptions& options) : options_(options) {}
  std::string name() const override { return "cpd-affine"; }
  std::string about() const override {
    return "affine coherent point drift on the vegetation points";
  }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    const PeerMaps maps = makePeerMaps(input, outcome.times);
    const auto most = static_cast<std::size_t>(options_.max_points);
    const PeerPoints points = makePeerPoints(maps, maps.space.uncertainty.translation + 1.0,
                                             4 * most, most, outcome.times);
    const paper::CpdResult result = outcome.times.run("cpd", [&] {
      return paper::refineByCpd(points.fixed, points.moving, {}, options_, maps.space.scale_axes);
    });
    if (!result.usable()) {
      outcome.why = fmt::format("no registration: {}", describe(result.status));
      return;
    }
    outcome.accepted = result.status == paper::CpdStatus::kConverged;
    if (!outcome.accepted) outcome.why = describe(result.status);
    setPlanePose(maps, input, result.pose.plane, outcome);
  }

 private:
  paper::CpdOptions options_;
};

}  // namespace

std::unique_ptr<Method> makeCpdAffine(const paper::CpdOptions& options) {
  return std::make_unique<CpdAffine>(options);
}

}  // namespace agricolmap::experiments
