#include "experiments/methods/product.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>

#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "experiments/methods/peer_maps.hpp"

namespace agricolmap::experiments {
namespace {

/// The variants of the paper's Tab. IV: only the flow's cost changes. The refinement tells plants
/// by their greenness in all of them.
constexpr std::string_view kVariants[] = {"paper:flow.describe.term=rgb",
                                          "paper:flow.describe.term=exg",
                                          "paper:flow.describe.term=height"};

/// The text before the first colon.
std::string presetOf(const std::string& name) { return name.substr(0, name.find(':')); }

/// Sets what stands after the preset's name.
void change(pipeline::RegistrationOptions& options, const std::string& name) {
  const OptionTable table = optionTable(options);
  for (std::size_t at = name.find(':'); at != std::string::npos;) {
    const std::size_t next = name.find(':', at + 1);
    const std::string setting = name.substr(at + 1, next - at - 1);
    const std::size_t equals = setting.find('=');
    const OptionField* field = table.find(setting.substr(0, equals));
    if (equals == std::string::npos || field == nullptr) {
      throw UsageError(fmt::format("method {}: '{}' is not KEY=VALUE of a known option{}", name,
                                   setting, config::suggestion(table, setting.substr(0, equals))));
    }
    config::parseOption(*field, setting.substr(equals + 1))();
    at = next;
  }
}

pipeline::RegistrationOptions optionsOf(const std::string& name, const PriorUncertainty& prior) {
  pipeline::RegistrationOptions options = pipeline::preset(presetOf(name));
  options.prior = prior;
  change(options, name);
  return options;
}

/// Of the offsets of the blocks that agree [m].
double blockRms(const verdict::Evidence& evidence) {
  double sum = 0.0;
  for (const verdict::BlockEvidence& block : evidence.blocks) {
    if (block.agrees) sum += block.offset.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(evidence.agreeing));
}

void addEvidence(const pipeline::Registration& result, MethodOutcome& outcome) {
  const pipeline::Placed& placed = *result.placed;
  const verdict::Evidence& evidence = placed.evidence;
  outcome.facts.insert(outcome.facts.end(),
                       {{"plane_probability", result.verdict.plane_probability},
                        {"place_probability", result.verdict.place_probability},
                        {"uniqueness", evidence.uniqueness},
                        {"significance", evidence.significance},
                        {"decoy", evidence.decoyRatio()},
                        {"agreeing", static_cast<double>(evidence.agreeing)},
                        {"blocks", static_cast<double>(evidence.blocks.size())},
                        {"overlap", placed.overlap},
                        {"block_rms", blockRms(evidence)},
                        {"correlation", placed.correlation},
                        {"heights_limited", result.verdict.heights.limited() ? 1.0 : 0.0}});
  if (placed.followed) {
    outcome.facts.insert(
        outcome.facts.end(),
        {{"bend_gain", placed.followed->bend.gain},
         {"slips", static_cast<double>(placed.followed->bend.deformation.slips.size())}});
  }
  if (!placed.uncertainty) return;
  outcome.facts.insert(outcome.facts.end(),
                       {{"expected_rms", placed.uncertainty->expected_rms},
                        {"systematic_rms", placed.uncertainty->systematic_rms},
                        {"local_rms", placed.uncertainty->local_rms},
                        {"scatter_rms", placed.uncertainty->scatter_rms},
                        {"height_deviation", placed.uncertainty->height_deviation}});
  outcome.stated = StatedError{*placed.uncertainty, result.maps.frames.levelled_from_fixed};
}

/// Where the points come to lie, and how sure that is. Outlives `result`.
void addDeformation(const pipeline::Registration& result, const Cloud& moving,
                    MethodOutcome& outcome) {
  outcome.aligned = pipeline::alignedCloud(result, moving);
  const pipeline::Displacement displacement(result, moving);
  for (const deform::Slip& slip : result.placed->followed->bend.deformation.slips) {
    outcome.slips.push_back(displacement.place(displacement.pathPoint(slip.along)));
  }
  auto kept = std::make_shared<const pipeline::Registration>(result);
  auto from = std::make_shared<const pipeline::Displacement>(*kept, moving);
  outcome.place_covariance = [kept, from](const Eigen::Vector3d& point) {
    return Eigen::Matrix2d(from->covarianceAt(point).topLeftCorner<2, 2>());
  };
}

}  // namespace

void fillFrom(const pipeline::Registration& result, const MethodInput& input,
              MethodOutcome& outcome) {
  outcome.accepted = result.verdict.status == verdict::Status::kAccepted;
  outcome.ambiguous = result.verdict.status == verdict::Status::kAmbiguous;
  if (!outcome.accepted) outcome.why = fmt::format("{}", fmt::join(result.verdict.reasons, "; "));
  const pipeline::Trace& trace = result.trace;
  outcome.facts.emplace_back("attempts", static_cast<double>(trace.attempts));
  if (result.transform) {
    outcome.fixed_from_moving = result.transform->fixed_from_moving;
    addEvidence(result, outcome);
    if (result.placed->followed) addDeformation(result, input.moving, outcome);
  }
  const pipeline::Located& found = trace.located;
  if (!found.flow) return;
  const auto coherent = [](const paper::MatchCount& count) {
    return static_cast<double>(count.inliers);
  };
  const pipeline::PairFrames& frames = result.maps.frames;
  addMatches("matches", frames, input, found.matches, coherent(found.flow->first), outcome);
  if (!found.flow->again) return;
  addMatches("rematches", frames, input, found.rematches, coherent(*found.flow->again), outcome);
}

std::vector<std::string> productNames() {
  std::vector<std::string> names = pipeline::presetNames();
  names.insert(names.end(), std::begin(kVariants), std::end(kVariants));
  return names;
}

std::optional<Method> makeProduct(const std::string& name) {
  const std::vector<std::string> presets = pipeline::presetNames();
  if (std::find(presets.begin(), presets.end(), presetOf(name)) == presets.end()) return {};
  pipeline::RegistrationOptions usual = optionsOf(name, {});
  const bool flow = usual.association == pipeline::AssociationKind::kFlow;
  Method method;
  method.name = name;
  method.about = name == presetOf(name) ? "the product's preset" : "the product's preset, changed";
  method.traits = {.matches_points = flow, .needs_guess = flow};
  method.options = config::dumpYaml(optionTable(usual));
  method.attempt = [name](const MethodInput& input, MethodOutcome& outcome) {
    Monitor monitor;
    const pipeline::Registration result = pipeline::registerClouds(
        input.fixed, input.moving, input.guess, optionsOf(name, input.prior), monitor);
    outcome.times.add(monitor);
    fillFrom(result, input, outcome);
  };
  return method;
}

}  // namespace agricolmap::experiments
