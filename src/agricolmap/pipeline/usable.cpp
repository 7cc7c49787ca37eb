#include "agricolmap/pipeline/usable.hpp"

#include <fmt/format.h>

#include <utility>

namespace agricolmap::pipeline {
namespace {

void requireColours(const CloudFacts& fixed, const CloudFacts& moving,
                    const RegistrationOptions& options) {
  if (options.geometry_only) return;
  for (const CloudFacts* cloud : {&fixed, &moving}) {
    if (!cloud->coloured) {
      throw InputError(
          fmt::format("{}: has no colours, which Excess Green needs{}; it can be registered by "
                      "heights alone",
                      cloud->name,
                      cloud->fields.empty() ? "" : fmt::format(" (it has {})", cloud->fields)),
          Remedy::kHeightsAlone);
    }
  }
}

}  // namespace

void requireUsable(const CloudFacts& fixed, const CloudFacts& moving,
                   const RegistrationOptions& options, bool located_otherwise) {
  requireColours(fixed, moving, options);
  if ((options.prior.anywhere() || options.prior.scale_unknown) && !located_otherwise &&
      options.association == AssociationKind::kFlow) {
    throw UsageError(
        "the flow needs to know about where to look and at what scale; the correlation search does "
        "not",
        Remedy::kNarrowerGuess);
  }
}

std::string workExceeded(const locate::SearchReport& report,
                         const locate::CorrelationOptions& options) {
  return fmt::format(
      "the search took {:.1f} times the work that search.max_work allows, even at cells of {:.2f} "
      "m: the fixed map is large for a guess as wide as this one; a narrower guess or a smaller "
      "fixed cloud is faster",
      report.work / options.max_work, report.cell);
}

void warnOfFlat(const map::GridMap& fixed, const map::GridMap& moving,
                const map::SignalOptions& signal, Monitor& monitor) {
  if (signal.term != map::SignalTerm::kAll && signal.term != map::SignalTerm::kExgHeight) return;
  for (const auto& [map, name] : {std::pair{&fixed, "fixed"}, {&moving, "moving"}}) {
    if (map::hasRelief(*map)) continue;
    monitor.warn(
        fmt::format("the {} cloud is flat: the maps are compared by their colours alone, and the "
                    "height of the result is that of the ground planes",
                    name));
  }
}

InputError fitsAtNoScale(const CloudFacts& fixed, const Cloud& moving) {
  return InputError(fmt::format(
      "{}: at no scale between 0.1 and 10 does it fit into the fixed map {} and still hold more "
      "than a few plants",
      moving.name, fixed.name));
}

}  // namespace agricolmap::pipeline
