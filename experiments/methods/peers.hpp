// The methods that the product is compared with. All but the last work in the plane on the
// product's own levelled maps: offset and tilt come from the ground as for the product. Options
// stand with their reasons in the sources.
#pragma once

#include <string>

#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// Affine ICP on the vegetation points: alternates nearest neighbours in space and the affine with
/// the least squares between them (Besl & McKay 1992, with an affine in place of the rigid motion).
/// Only the six horizontal parameters are free: near-planar points cannot tell tilt, and a free one
/// would spoil the result.
void icpAffine(const MethodInput& input, MethodOutcome& outcome);

/// Coherent point drift, affine, on the vegetation points: the product's, with what makes it a
/// refinement, and not a registration, switched off. paper/cpd/cpd.hpp says in what it differs from
/// the article.
void cpdAffine(const MethodInput& input, MethodOutcome& outcome);

/// The paper's chain with sparse features in place of the flow (Sec. V-B): detection, description
/// and matching on the Excess Green map; vote, affine and CPD unchanged. Features of SURF, of ORB,
/// and of FAST with BRIEF.
void surfChain(const MethodInput& input, MethodOutcome& outcome);
void orbChain(const MethodInput& input, MethodOutcome& outcome);
void fastBriefChain(const MethodInput& input, MethodOutcome& outcome);

/// SIFT on the Excess Green maps, nearest neighbours within what the guess allows with Lowe's
/// ratio, and an affine by USAC with the MAGSAC++ score (Barath et al. 2020).
void siftAffine(const MethodInput& input, MethodOutcome& outcome);

/// FPFH, fast global registration and generalised ICP on the clouds themselves, ground and plants,
/// levelled and cut to what the guess allows: what a practitioner would run today. Rigid, in three
/// dimensions. Accepted when it lies within the limits of the guess: a field fits itself nearly
/// everywhere, so its fitness tells nothing.
void fpfhGicp(const MethodInput& input, MethodOutcome& outcome);

}  // namespace agricolmap::experiments
