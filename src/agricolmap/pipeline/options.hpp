// All options of a registration, in the order of the pipeline, and the presets.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/deform/deform.hpp"
#include "agricolmap/locate/correlation_search.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/hidden_ground.hpp"
#include "agricolmap/map/level.hpp"
#include "agricolmap/map/signal_map.hpp"
#include "agricolmap/map/vegetation.hpp"
#include "agricolmap/paper/cpd/cpd.hpp"
#include "agricolmap/paper/estimate_affine.hpp"
#include "agricolmap/paper/flow_association.hpp"
#include "agricolmap/pieces/chain.hpp"
#include "agricolmap/refine/dense_refine.hpp"
#include "agricolmap/refine/vertical.hpp"
#include "agricolmap/verdict/uncertainty.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::pipeline {

enum class AssociationKind { kCorrelation, kFlow };
enum class RefineKind { kDense, kCpd };
/// kPath: bends and slips are followed along the path of the strip.
enum class DeformKind { kNone, kPath };

struct RegistrationOptions {
  bool geometry_only = false;  ///< use heights alone; needed for clouds without colours
  AssociationKind association = AssociationKind::kCorrelation;
  RefineKind refine = RefineKind::kDense;
  DeformKind deform = DeformKind::kPath;
  int seed = 1;
  bool require_heights = false;  ///< reject what is right in the plane but not in height
  bool straighten = true;        ///< lay strips that drift has bent by their blocks
  PriorUncertainty prior;
  map::LevelOptions level;
  map::GridOptions grid;
  map::SignalOptions signal;
  correlation::MatchedFilterOptions filter;
  locate::CorrelationOptions search;
  pieces::PiecesOptions pieces;
  paper::FlowAssociationOptions flow;
  paper::AffineOptions affine;
  map::HiddenGroundOptions hidden;
  refine::DenseRefineOptions dense;
  map::VegetationOptions vegetation;
  paper::CpdOptions cpd;
  refine::VerticalOptions vertical;
  deform::BendOptions bend;
  verdict::EvidenceOptions evidence;
  verdict::UncertaintyOptions uncertainty;
  verdict::VerdictOptions verdict;
};
void listOptions(OptionTable& table, RegistrationOptions& options);

/// Of a chain that does not refine densely, where the verdict does it all the same: the defaults.
refine::DenseRefineOptions denseInForce(const RegistrationOptions& options);

/// Whether long strips are placed piece by piece: by the default chain, at a known scale.
bool placesByPieces(const RegistrationOptions& options);

/// The options as they are in force: what one of them decides for others is written there, so that
/// what is reported is what was done. Whoever registers calls this first; calling it again changes
/// nothing. Throws UsageError for values outside their limits, alone or beside one another.
RegistrationOptions resolved(const RegistrationOptions& chosen);

/// What the option at `path` needs to do anything and does not have under `options`, in words such
/// as `association = flow`; empty when it has an effect.
std::string missingFor(const RegistrationOptions& options, std::string_view path);

/// Names of the presets: "default" measures best; "paper" is the paper's chain and parameters, its
/// steps replaced where others reach the range of errors that the paper reports; "paper-literal"
/// is that chain as it is written, as far as it is (docs/paper-chain.md has both side by side).
std::vector<std::string> presetNames();
/// Throws UsageError for an unknown name.
RegistrationOptions preset(const std::string& name);

}  // namespace agricolmap::pipeline
