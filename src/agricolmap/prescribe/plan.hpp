// From a layer of a map to a rate for each square: means, classes, rates and what they need.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/prescribe/lattice.hpp"
#include "agricolmap/prescribe/rate.hpp"

namespace agricolmap::prescribe {

/// Mean of the layer in each square; NaN where less than `least_seen` of the square is known.
/// `frame`: in file coordinates.
Raster<float> squareMeans(const GridFrame& frame, const Raster<float>& values,
                          const Lattice& lattice, const Earth& earth, double least_seen);

/// Takes away border rows and columns without any known value. False when none has one.
bool trim(Lattice& lattice, Raster<float>& means);

/// The breaks that part what is known into `count` classes of about as many squares each, rounded
/// to three digits. Throws InputError when there are not as many different ones.
std::vector<double> quantileBreaks(const Raster<float>& means, int count);

/// One class of values and what it gets.
struct ClassShare {
  double rate = 0.0;            ///< in the unit
  std::int32_t task_value = 0;  ///< the same in steps of the data dictionary
  std::size_t squares = 0;
  double area = 0.0;    ///< [m²]
  double amount = 0.0;  ///< of product
};

/// A rate for each square.
struct Plan {
  Lattice lattice;
  Raster<float> means;        ///< of the layer, NaN where too little is known
  Raster<std::uint8_t> code;  ///< 0: not known, gets nothing; else the class, from 1
  RateUnit unit;
  std::vector<double> breaks;       ///< between the classes; a value on a break is above it
  std::vector<ClassShare> classes;  ///< lowest values first, one more than breaks
  double area = 0.0;                ///< of all classes [m²]
  double amount = 0.0;              ///< of product, with the rates that a task file can say
};

/// Throws UsageError when there is not one rate per class, there are more than kMostClasses, breaks
/// do not rise, or a rate cannot be said (taskValue).
Plan planOf(Lattice lattice, Raster<float> means, const std::vector<double>& breaks,
            const std::vector<double>& rates, const RateUnit& unit, const Earth& earth);

inline constexpr std::size_t kMostClasses = 60;

/// A plan on squares of longitude and latitude, as task files need it.
struct TaskGrid {
  Lattice lattice;
  Raster<std::uint8_t> code;
  double amount = 0.0;  ///< of product by this grid
};

/// The plan's own squares, or, where these are turned, cells of a quarter of their shorter side
/// that have the code of the square under their middle.
TaskGrid taskGridOf(const Plan& plan, const Earth& earth);

}  // namespace agricolmap::prescribe
