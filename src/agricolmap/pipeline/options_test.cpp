#include "agricolmap/pipeline/options.hpp"

#include <gtest/gtest.h>

#include <string>

#include "agricolmap/core/error.hpp"

namespace agricolmap::pipeline {
namespace {

TEST(RegistrationOptions, AboutThirtyAreForUsers) {
  RegistrationOptions options;
  int basic = 0;
  const OptionTable table = optionTable(options);
  for (const OptionField& field : table.fields()) {
    if (field.level == OptionLevel::kBasic) ++basic;
  }
  EXPECT_GE(basic, 25);
  EXPECT_LE(basic, 35);
}

TEST(RegistrationOptions, EveryGroupSaysWhatItIsAbout) {
  RegistrationOptions options;
  const OptionTable table = optionTable(options);
  for (const OptionField& field : table.fields()) {
    if (field.group().empty()) continue;
    EXPECT_FALSE(table.titleOf(field.group()).empty()) << field.path;
  }
}

TEST(RegistrationOptions, WhatOneDecidesForOthersIsWrittenThere) {
  RegistrationOptions options;
  options.geometry_only = true;
  options.filter.floor = 0.2;
  options.seed = 9;
  const RegistrationOptions in_force = resolved(options);
  EXPECT_EQ(in_force.signal.term, map::SignalTerm::kHeight);
  // What has no effect stays as it is: a file with it is no request.
  EXPECT_EQ(in_force.flow.describe.term, map::DataTerm::kExgHeight);
  EXPECT_EQ(in_force.search.filter.floor, 0.2);
  EXPECT_EQ(in_force.flow.seed, 9);
  EXPECT_EQ(in_force.affine.seed, 9);
  options.association = AssociationKind::kFlow;
  EXPECT_EQ(resolved(options).flow.describe.term, map::DataTerm::kHeight);
}

TEST(RegistrationOptions, LimitsAreCheckedAloneAndBesideOneAnother) {
  RegistrationOptions options;
  options.flow.describe.daisy.radius = 1.0;
  EXPECT_THROW(resolved(options), UsageError);
  options = preset("paper");
  options.cpd.sigma_end = 2.0 * options.cpd.sigma_start;
  EXPECT_THROW(resolved(options), UsageError);
  options.refine = RefineKind::kDense;
  EXPECT_NO_THROW(resolved(options));
}

TEST(RegistrationOptions, NamesWhatAnOptionNeedsToHaveAnEffect) {
  RegistrationOptions options;
  EXPECT_EQ(missingFor(options, "grid.cell"), "");
  EXPECT_EQ(missingFor(options, "search.cell"), "");
  EXPECT_EQ(missingFor(options, "flow.flow.levels"), "association = flow");
  EXPECT_EQ(missingFor(options, "affine.least"), "association = flow");
  EXPECT_EQ(missingFor(options, "cpd.decay"), "refine = cpd");
  EXPECT_EQ(missingFor(options, "dense.hop"), "");
  options.dense.hops = 0;
  EXPECT_EQ(missingFor(options, "dense.hop"), "dense.hops of 1 or more");
  EXPECT_EQ(missingFor(options, "dense.hops"), "");
  options = preset("paper");
  EXPECT_EQ(missingFor(options, "search.cell"), "association = correlation");
  EXPECT_EQ(missingFor(options, "dense.iterations"), "refine = dense");
  EXPECT_EQ(missingFor(options, "flow.scale_tolerance"), "");
  EXPECT_EQ(missingFor(options, "cpd.published.tolerance"), "cpd.kind = published");
  options = preset("paper-literal");
  EXPECT_EQ(missingFor(options, "flow.scale_tolerance"), "flow.warps = true");
  EXPECT_EQ(missingFor(options, "cpd.decay"), "cpd.kind = adapted");
  EXPECT_EQ(missingFor(options, "cpd.published.tolerance"), "");
  EXPECT_EQ(missingFor(options, "flow.vote.tolerance"), "flow.vote.kind = pose");
  EXPECT_EQ(missingFor(options, "affine.tukey"), "affine.robust = true");
}

}  // namespace
}  // namespace agricolmap::pipeline
