#include "agricolmap/pipeline/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "agricolmap/core/error.hpp"

namespace agricolmap::pipeline {

void listOptions(OptionTable& table, RegistrationOptions& options) {
  table
      .flag("geometry_only", options.geometry_only,
            "use heights alone, as clouds without colours need")
      .basic();
  table
      .choice("association", options.association, {"correlation", "flow"},
              "how the moving map is placed: global correlation search or the paper's flow")
      .basic();
  table
      .choice("refine", options.refine, {"dense", "cpd"},
              "how the placement is refined: Gauss-Newton on the maps, or CPD on the vegetation")
      .basic();
  table
      .choice("deform", options.deform, {"none", "path"},
              "whether a strip that drift has bent, or of which a part slipped, is followed by a "
              "smooth displacement along its path")
      .basic();
  table.integer("seed", options.seed, 0, 2147483647, "", "what everything random follows from")
      .basic();
  table
      .flag("require_heights", options.require_heights,
            "reject a place whose heights are limited, instead of saying so")
      .basic();
  table.flag(
      "straighten", options.straighten,
      "lay a strip by its blocks where neighbouring ones are displaced alike, as by drift, if "
      "it then fits better");
  table.group("prior", options.prior, "how wrong the initial guess may be");
  table.group("level", options.level, "levelling");
  table.group("grid", options.grid, "the grid maps");
  table.group("signal", options.signal, "what of the maps is compared");
  table.group("filter", options.filter, "the matched filter of the search and of the evidence");
  table.group("search", options.search, "the correlation search (association = correlation)");
  table.group("pieces", options.pieces, "long strips, piece by piece (the default chain)");
  table.group("flow", options.flow, "the paper's flow and vote (association = flow)");
  table.group("affine", options.affine, "the affine from the flow's matches (association = flow)");
  table.group("hidden", options.hidden, "ground that plants hide from the robot");
  table.group("dense", options.dense, "the refinement on the maps (refine = dense)");
  table.group("vegetation", options.vegetation, "telling plants from soil (refine = cpd)");
  table.group("cpd", options.cpd, "coherent point drift (refine = cpd)");
  table.group("vertical", options.vertical, "tilt and height");
  table.group("bend", options.bend, "following a strip that bends or slipped (deform = path)");
  table.group("evidence", options.evidence, "what the verdict rests on");
  table.group("uncertainty", options.uncertainty, "the stated error");
  table.group("verdict", options.verdict, "when a registration is accepted");
}

namespace {

bool correlates(const RegistrationOptions& options) {
  return options.association == AssociationKind::kCorrelation;
}
bool flows(const RegistrationOptions& options) {
  return options.association == AssociationKind::kFlow;
}
bool refinesDensely(const RegistrationOptions& options) {
  return options.refine == RefineKind::kDense;
}
bool isDefaultChain(const RegistrationOptions& options) {
  return correlates(options) && refinesDensely(options);
}
bool followsSoil(const RegistrationOptions& options) {
  return refinesDensely(options) && options.dense.soil.follow;
}
bool followsBends(const RegistrationOptions& options) {
  return options.deform == DeformKind::kPath && options.refine == RefineKind::kDense;
}
bool refinesByPoints(const RegistrationOptions& options) {
  return options.refine == RefineKind::kCpd;
}
bool adaptsCpd(const RegistrationOptions& options) {
  return options.cpd.kind == paper::CpdKind::kAdapted;
}
bool publishedCpd(const RegistrationOptions& options) {
  return options.cpd.kind == paper::CpdKind::kPublished;
}
bool votesForPoses(const RegistrationOptions& options) {
  return options.flow.vote.kind == paper::VoteKind::kPose;
}
bool setsOutliersAside(const RegistrationOptions& options) { return options.affine.robust; }

/// What options need to have an effect.
struct Need {
  std::string_view path;  ///< of an option, or of a group with its dot
  bool (*met)(const RegistrationOptions&);
  std::string_view words;
};
constexpr std::array kNeeds = {
    Need{"search.", correlates, "association = correlation"},
    Need{"pieces.", isDefaultChain, "association = correlation and refine = dense"},
    Need{"flow.", flows, "association = flow"},
    Need{"affine.", flows, "association = flow"},
    Need{"dense.", refinesDensely, "refine = dense"},
    Need{"straighten", refinesDensely, "refine = dense"},
    Need{"bend.", followsBends, "deform = path and refine = dense"},
    Need{"deform", refinesDensely, "refine = dense"},
    Need{"vegetation.", refinesByPoints, "refine = cpd"},
    Need{"cpd.", refinesByPoints, "refine = cpd"},
    Need{"flow.vote.coarse", votesForPoses, "flow.vote.kind = pose"},
    Need{"flow.vote.tolerance", votesForPoses, "flow.vote.kind = pose"},
    Need{"affine.tukey", setsOutliersAside, "affine.robust = true"},
    Need{"affine.starts", setsOutliersAside, "affine.robust = true"},
    Need{"cpd.published.", publishedCpd, "cpd.kind = published"},
    Need{"cpd.sigma_start", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.sigma_end", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.decay", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.sigma_height", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.outlier_share", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.border", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.start_weight", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.max_points", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.max_iterations", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.tolerance", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.max_motion", adaptsCpd, "cpd.kind = adapted"},
    Need{"cpd.min_matched", adaptsCpd, "cpd.kind = adapted"},
    Need{"signal.term",
         [](const RegistrationOptions& o) {
           return !o.geometry_only || o.signal.term == map::SignalTerm::kHeight;
         },
         "geometry_only = false"},
    Need{"flow.describe.term",
         [](const RegistrationOptions& o) {
           return !o.geometry_only || o.flow.describe.term == map::DataTerm::kHeight;
         },
         "geometry_only = false"},
    Need{"flow.heading_tolerance_deg", [](const RegistrationOptions& o) { return o.flow.warps; },
         "flow.warps = true"},
    Need{"flow.scale_tolerance", [](const RegistrationOptions& o) { return o.flow.warps; },
         "flow.warps = true"},
    Need{"hidden.radius", [](const RegistrationOptions& o) { return o.hidden.fill; },
         "hidden.fill = true"},
    Need{"hidden.whole", [](const RegistrationOptions& o) { return o.hidden.fill; },
         "hidden.fill = true"},
    Need{"hidden.bare", [](const RegistrationOptions& o) { return o.hidden.fill; },
         "hidden.fill = true"},
    Need{"dense.hop", [](const RegistrationOptions& o) { return o.dense.hops > 0; },
         "dense.hops of 1 or more"},
    Need{"dense.soil.wave", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.bare", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.margin", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.reach", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.share", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.agree", followsSoil, "dense.soil.follow = true"},
    Need{"dense.soil.clear", followsSoil, "dense.soil.follow = true"},
};

}  // namespace

RegistrationOptions resolved(const RegistrationOptions& chosen) {
  checkOptions(chosen);
  if (refinesByPoints(chosen) && chosen.cpd.sigma_end > chosen.cpd.sigma_start) {
    throw UsageError(fmt::format("option cpd.sigma_end = {} is larger than cpd.sigma_start = {}",
                                 chosen.cpd.sigma_end, chosen.cpd.sigma_start));
  }
  RegistrationOptions options = chosen;
  if (options.geometry_only) {
    options.signal.term = map::SignalTerm::kHeight;
    if (flows(options)) options.flow.describe.term = map::DataTerm::kHeight;
  }
  options.search.filter = options.filter;
  options.flow.seed = options.seed;
  options.affine.seed = options.seed;
  return options;
}

refine::DenseRefineOptions denseInForce(const RegistrationOptions& options) {
  return refinesDensely(options) ? options.dense : refine::DenseRefineOptions{};
}

bool placesByPieces(const RegistrationOptions& options) {
  return isDefaultChain(options) && !options.prior.scale_unknown;
}

std::string missingFor(const RegistrationOptions& options, std::string_view path) {
  for (const Need& need : kNeeds) {
    const bool concerned =
        need.path.ends_with('.') ? path.starts_with(need.path) : path == need.path;
    if (concerned && !need.met(options)) return std::string(need.words);
  }
  return {};
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
    options.signal.term = map::SignalTerm::kExgHeight;
    options.hidden.fill = false;
    options.vertical.scale = refine::VerticalScaleKind::kAssumed;
    if (name == "paper-literal") makeLiteral(options);
    return options;
  }
  throw UsageError(
      fmt::format("unknown preset '{}'; there are: {}", name, fmt::join(presetNames(), ", ")));
}

}  // namespace agricolmap::pipeline
