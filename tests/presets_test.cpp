// Every preset through the whole pipeline, on a pair that all of them should master: a small field,
// and a guess that is off by what one flow and one vote for a displacement can bear.
#include <gtest/gtest.h>

#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

simulate::SimulatedPair easyPair() {
  simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  options.field.width = 10.0;
  options.field.height = 10.0;
  options.ugv.length = 5.0;
  options.geotag.translation = 0.4;
  options.geotag.heading_deg = 0.4;
  options.geotag.scale = 0.005;
  options.geotag.z = 0.1;
  options.seed = 21;
  return simulate::simulatePair(options);
}

TEST(Presets, AllAreRightOnAnEasyPair) {
  const simulate::SimulatedPair pair = easyPair();
  const evaluate::Truth truth{pair.best_affine, pair.truth};
  EXPECT_FALSE(evaluate::evaluateTransform(pair.prior, truth, pair.ugv).within({}));
  for (const std::string& name : pipeline::presetNames()) {
    SCOPED_TRACE(name);
    pipeline::RegistrationOptions options = pipeline::preset(name);
    options.prior.translation = 1.0;
    options.prior.heading_deg = 2.0;
    options.prior.scale = 0.03;
    options.cpd.published.max_points = 1500;  // as right, and quick
    Monitor monitor;
    const pipeline::Registration result =
        pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor);
    ASSERT_TRUE(result.transform);
    const evaluate::RegistrationErrors errors =
        evaluate::evaluateTransform(result.transform->fixed_from_moving, truth, pair.ugv);
    EXPECT_TRUE(errors.within({}))
        << "RMS " << errors.rms << " m, e_t " << errors.translation << " m, e_s " << errors.scale;
  }
}

TEST(Presets, LiteralDiffersFromPaperInItsSteps) {
  const pipeline::RegistrationOptions literal = pipeline::preset("paper-literal");
  const pipeline::RegistrationOptions ours = pipeline::preset("paper");
  EXPECT_FALSE(literal.flow.cost.normalise);
  EXPECT_TRUE(ours.flow.cost.normalise);
  EXPECT_EQ(literal.flow.vote.kind, paper::VoteKind::kDisplacement);
  EXPECT_EQ(ours.flow.vote.kind, paper::VoteKind::kPose);
  EXPECT_EQ(literal.cpd.kind, paper::CpdKind::kPublished);
  EXPECT_EQ(ours.cpd.kind, paper::CpdKind::kAdapted);
  EXPECT_EQ(literal.flow.describe.fpfh.exaggeration, 1.0);
  EXPECT_EQ(literal.flow.describe.daisy.shrink, 1.0);
  EXPECT_FALSE(literal.flow.warps || literal.flow.rematch || literal.affine.robust);
  // The paper's parameters (Tab. III) are those of both.
  for (const pipeline::RegistrationOptions& options : {literal, ours}) {
    EXPECT_EQ(options.flow.cost.alpha, 1.0);
    EXPECT_EQ(options.flow.cost.beta, 0.5);
    EXPECT_EQ(options.grid.cell, 0.02);
    EXPECT_EQ(options.flow.vote.step, 1.0);
    EXPECT_EQ(options.grid.exg, map::ExgKind::kPlain);
  }
}

}  // namespace
}  // namespace agricolmap
