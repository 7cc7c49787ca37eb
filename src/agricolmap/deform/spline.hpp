// A uniform cubic B-spline over path length.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace agricolmap::deform {

class SplineBasis {
 public:
  /// Over [0, length] with nodes `spacing` apart, or a little less so that the ends are nodes [m].
  SplineBasis(double length, double spacing)
      : spans_(std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)))),
        spacing_(length / spans_) {}
  /// With so many spans of exactly this length [m], as another one says that it has.
  static SplineBasis ofSpans(int spans, double spacing) {
    SplineBasis basis(spacing, spacing);
    basis.spans_ = spans;
    basis.spacing_ = spacing;
    return basis;
  }

  /// The four coefficients that a place hangs on, by value and by derivative [1/m].
  struct At {
    int first = 0;
    std::array<double, 4> value{};
    std::array<double, 4> slope{};
  };
  /// Beyond the ends it goes straight on.
  At at(double along) const {
    const double within = std::clamp(along / spacing_, 0.0, static_cast<double>(spans_));
    At at;
    at.first = std::min(static_cast<int>(within), spans_ - 1);
    const double u = within - at.first, v = 1.0 - u;
    at.value = {v * v * v / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
                (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0, u * u * u / 6.0};
    at.slope = {-0.5 * v * v, 0.5 * (3.0 * u * u - 4.0 * u), 0.5 * (4.0 * v - 3.0 * v * v),
                0.5 * u * u};
    const double beyond = along - spacing_ * within;
    for (std::size_t i = 0; i < 4; ++i) {
      at.slope[i] /= spacing_;
      at.value[i] += beyond * at.slope[i];
    }
    return at;
  }

  int spans() const { return spans_; }
  int size() const { return spans_ + 3; }      ///< number of coefficients
  double spacing() const { return spacing_; }  ///< of the nodes [m]
  double length() const { return spacing_ * spans_; }
  /// Where coefficient i counts most: coefficients that are a linear function of these places make
  /// that function.
  double place(int i) const { return spacing_ * (i - 1); }

 private:
  int spans_;
  double spacing_;
};

/// Where x of a coefficient stands among unknowns of which each coefficient, and then each slip,
/// has x and y; y is the next.
inline Eigen::Index unknownOf(int coefficient) { return Eigen::Index{2} * coefficient; }

}  // namespace agricolmap::deform
