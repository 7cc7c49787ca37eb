#include "register_pair.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/evaluate/coverage.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::campaign {
namespace {

constexpr const char* kScaleUnknown = "prior.scale_unknown";

std::string stageText(const StageTimes& times) {
  std::string text;
  for (const auto& [stage, seconds] : times.stages()) {
    text += fmt::format("{}{}={:.4f}", text.empty() ? "" : ";", stage, seconds);
  }
  return text;
}

/// What the program found out about its answer.
void fillEvidence(const pipeline::Registration& result, PairRow& row) {
  for (const auto& [name, value] : result.counts) {
    if (name == "attempts") row.attempts = value;
  }
  if (!result.has_transform) return;
  row.uniqueness = result.evidence.uniqueness;
  row.agreement = result.evidence.agreement();
  row.significance = result.evidence.significance;
  row.overlap = result.overlap;
  row.correlation = result.correlation;
  if (result.uncertainty) {
    row.expected_rms = result.uncertainty->expected_rms;
    row.local_rms = result.uncertainty->local_rms;
    row.height_deviation = result.uncertainty->height_deviation;
  }
  row.blocks = static_cast<double>(result.evidence.blocks.size());
  double sum = 0.0;
  for (const verdict::BlockEvidence& block : result.evidence.blocks) {
    if (block.agrees) sum += block.offset.squaredNorm();
  }
  if (result.evidence.agreeing > 0) {
    row.block_rms = std::sqrt(sum / static_cast<double>(result.evidence.agreeing));
  }
}

}  // namespace

bool knowsScaleUnknown() {
  pipeline::RegistrationOptions options;
  return optionTable(options).find(kScaleUnknown) != nullptr;
}

pipeline::RegistrationOptions variant(const std::string& text, const CampaignCase& chosen) {
  const std::size_t end = text.find(':');
  pipeline::RegistrationOptions options = pipeline::preset(text.substr(0, end));
  const OptionTable table = optionTable(options);
  if (chosen.prior) options.prior = *chosen.prior;
  if (chosen.scale_unknown) config::parseOption(*table.find(kScaleUnknown), "true")();
  for (std::size_t at = end; at != std::string::npos;) {
    const std::size_t next = text.find(':', at + 1);
    const std::string setting = text.substr(at + 1, next - at - 1);
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    const OptionField* field = table.find(key);
    if (equals == std::string::npos || field == nullptr) {
      throw UsageError(
          fmt::format("--presets {}: '{}' is not KEY=VALUE of a known option", text, setting));
    }
    config::parseOption(*field, setting.substr(equals + 1))();
    at = next;
  }
  return options;
}

bool canRegister(const std::string& preset_name, const CampaignCase& chosen) {
  const pipeline::RegistrationOptions options = variant(preset_name, chosen);
  return options.association != pipeline::AssociationKind::kFlow ||
         (!options.prior.anywhere() && !chosen.scale_unknown);
}

PairRow registerPair(const CampaignPair& pair, const std::string& preset_name,
                     const CampaignCase& chosen) {
  PairRow row;
  row.preset = preset_name;
  row.negative = !pair.overlaps;
  row.fixed_points = pair.fixed->size();
  row.moving_points = pair.moving.size();
  row.errors = noErrors();
  StageTimes times;
  const Stopwatch watch;
  try {
    const pipeline::Registration result = pipeline::registerClouds(
        *pair.fixed, pair.moving, pair.prior, variant(preset_name, chosen), times);
    row.total_s = watch.seconds();
    row.accepted = result.verdict.status == verdict::Status::kAccepted;
    row.status = toString(result.verdict.status);
    fillEvidence(result, row);
    row.probability = result.verdict.probability;
    if (const auto coverage = evaluate::coverageOf(result, *pair.fixed, pair.moving, pair.truth)) {
      row.mahalanobis2 = coverage->pose_distance2;
      row.centre_mahalanobis2 = coverage->shift_distance2;
      row.height_mahalanobis2 = coverage->height_distance2;
    }
    if (result.has_transform) {
      row.errors = evaluate::evaluateTransform(result.fixed_from_moving, pair.truth, pair.moving);
      row.correct = pair.overlaps && row.errors.within({});
    }
    if (!row.accepted) row.note = fmt::format("{}", fmt::join(result.verdict.reasons, "; "));
  } catch (const InputError& error) {
    // A pair that cannot be used counts as one that was not registered.
    row.total_s = watch.seconds();
    row.note = error.what();
  }
  row.stages = stageText(times);
  return row;
}

}  // namespace agricolmap::campaign
