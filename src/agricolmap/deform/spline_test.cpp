#include "agricolmap/deform/spline.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace agricolmap::deform {
namespace {

double valueAt(const SplineBasis& basis, double along, const std::function<double(double)>& f) {
  const SplineBasis::At at = basis.at(along);
  double value = 0.0;
  for (int i = 0; i < 4; ++i) {
    value += at.value[static_cast<std::size_t>(i)] * f(basis.place(at.first + i));
  }
  return value;
}

TEST(Spline, MakesLinesOfTheirPlaces) {
  const SplineBasis basis(9.7, 1.25);
  const auto line = [](double s) { return 0.3 - 0.02 * s; };
  for (const double along : {-0.8, 0.0, 0.01, 3.3, 4.85, 9.7, 10.5}) {
    EXPECT_NEAR(valueAt(basis, along, line), line(along), 1e-12) << along;
  }
}

TEST(Spline, SlopesAreThoseOfItsValues) {
  const SplineBasis basis(10.0, 1.0);
  const auto wave = [](double s) { return std::sin(s); };
  constexpr double kStep = 1e-6;
  for (const double along : {0.3, 2.0, 5.5, 9.9}) {
    const SplineBasis::At at = basis.at(along);
    double slope = 0.0;
    for (int i = 0; i < 4; ++i) {
      slope += at.slope[static_cast<std::size_t>(i)] * wave(basis.place(at.first + i));
    }
    const double numeric =
        (valueAt(basis, along + kStep, wave) - valueAt(basis, along - kStep, wave)) / (2.0 * kStep);
    EXPECT_NEAR(slope, numeric, 1e-6) << along;
  }
}

TEST(Spline, HasOneSpanAtLeast) {
  EXPECT_EQ(SplineBasis(0.5, 10.0).size(), 4);
  EXPECT_EQ(SplineBasis(10.0, 2.0).size(), 8);
  EXPECT_DOUBLE_EQ(SplineBasis(10.0, 3.0).spacing(), 2.5);
}

}  // namespace
}  // namespace agricolmap::deform
