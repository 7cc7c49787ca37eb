// All options of a registration, in the order of the pipeline, and the presets.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/1_level/level.hpp"
#include "agricolmap/2_grid/grid_map.hpp"
#include "agricolmap/2_grid/hidden_ground.hpp"
#include "agricolmap/2_grid/signal_map.hpp"
#include "agricolmap/4_associate/association.hpp"
#include "agricolmap/4_associate/correlate/correlation_search.hpp"
#include "agricolmap/4_associate/flow_association.hpp"
#include "agricolmap/5_affine/estimate_affine.hpp"
#include "agricolmap/6_refine/cpd.hpp"
#include "agricolmap/6_refine/dense_refine.hpp"
#include "agricolmap/6_refine/vegetation.hpp"
#include "agricolmap/6_refine/vertical.hpp"
#include "agricolmap/7_verdict/uncertainty.hpp"
#include "agricolmap/7_verdict/verdict.hpp"
#include "agricolmap/core/options.hpp"

namespace agricolmap {

enum class AssociationKind { kCorrelation, kFlow };
/// kDenseCpd: densely, then the mean of that and CPD from there, where the vegetation can be told
/// from the soil.
enum class RefineKind { kDenseCpd, kDense, kCpd, kNone };

struct RegistrationOptions {
  bool geometry_only = false;  ///< use heights alone; needed for clouds without colours
  AssociationKind association = AssociationKind::kCorrelation;
  RefineKind refine = RefineKind::kDense;
  PriorUncertainty prior;
  LevelOptions level;
  GridOptions grid;
  SignalOptions signal;
  CorrelationOptions search;
  FlowAssociationOptions flow;
  AffineOptions affine;
  HiddenGroundOptions hidden;
  DenseRefineOptions dense;
  VegetationOptions vegetation;
  CpdOptions cpd;
  VerticalOptions vertical;
  EvidenceOptions evidence;
  UncertaintyOptions uncertainty;
  VerdictOptions verdict;
};
void describe(OptionTable& table, RegistrationOptions& options);

/// Names of the presets: "default" measures best; "paper" is the paper's chain and parameters, with
/// the moving map matched under several warps, which the range of errors that the paper reports
/// needs; "paper-literal" is that chain with one flow from the guess as it is.
std::vector<std::string> presetNames();
/// Throws UsageError for an unknown name.
RegistrationOptions preset(const std::string& name);

}  // namespace agricolmap
