#include "agricolmap/pipeline/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "agricolmap/core/error.hpp"

namespace agricolmap::pipeline {

void describe(OptionTable& table, RegistrationOptions& options) {
  table.flag("geometry_only", options.geometry_only,
             "use heights alone, as clouds without colours need");
  table.choice("association", options.association, {"correlation", "flow"},
               "how the moving map is placed: global correlation search or the paper's flow");
  table.choice(
      "refine", options.refine, {"dense+cpd", "dense", "cpd", "none"},
      "how the placement is refined: Gauss-Newton on the maps, CPD on the vegetation, or both");
  table.group("prior", options.prior);
  table.group("level", options.level);
  table.group("grid", options.grid);
  table.group("signal", options.signal);
  table.group("search", options.search);
  table.group("flow", options.flow);
  table.group("affine", options.affine);
  table.group("hidden", options.hidden);
  table.group("dense", options.dense);
  table.group("vegetation", options.vegetation);
  table.group("cpd", options.cpd);
  table.group("vertical", options.vertical);
  table.group("evidence", options.evidence);
  table.group("uncertainty", options.uncertainty);
  table.group("verdict", options.verdict);
}

namespace {

/// The paper's own choices in place of those that work better; docs/paper-chain.md tells why.
void makeLiteral(RegistrationOptions& options) {
  // One flow from the guess as it is does not reach the 30 % and 11.5° that the paper reports;
  // one flow per part of that range does.
  options.flow.warps = false;
  options.flow.rematch = false;
  options.flow.describe.empty = paper::EmptyCells::kZero;
  options.flow.describe.daisy.norm = paper::DaisyNorm::kPartial;
  options.flow.describe.daisy.shrink = 1.0;
  options.flow.describe.fpfh.exaggeration = 1.0;
  options.flow.cost.normalise = false;
  options.flow.vote.kind = paper::VoteKind::kDisplacement;
  options.affine.robust = false;
  options.cpd.kind = paper::CpdKind::kPublished;
}

}  // namespace

std::vector<std::string> presetNames() { return {"default", "paper", "paper-literal"}; }

RegistrationOptions preset(const std::string& name) {
  RegistrationOptions options;
  if (name == "default") return options;
  if (name == "paper" || name == "paper-literal") {
    options.association = AssociationKind::kFlow;
    options.refine = RefineKind::kCpd;
    options.grid.exg = map::ExgKind::kPlain;
    options.grid.coarsen = false;
    options.hidden.fill = false;
    if (name == "paper-literal") makeLiteral(options);
    return options;
  }
  throw UsageError(
      fmt::format("unknown preset '{}'; there are: {}", name, fmt::join(presetNames(), ", ")));
}

}  // namespace agricolmap::pipeline
