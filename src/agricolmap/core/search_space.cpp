#include "agricolmap/core/search_space.hpp"

#include <cmath>

namespace agricolmap {

void listOptions(OptionTable& table, PriorUncertainty& options) {
  table
      .number("translation", options.translation, 0.0, kAnywhere, "m",
              "how far off the initial guess may be, horizontally (paper: 5); 1e6: anywhere in the "
              "fixed map")
      .basic();
  table
      .number("heading_deg", options.heading_deg, 0.0, 180.0, "deg",
              "how far off its heading may be (paper: 11.5)")
      .basic();
  table
      .number("scale", options.scale, 0.0, 0.5, "",
              "how far off each horizontal scale may be, relative (paper: 0.30)")
      .basic();
  table
      .flag("scale_unknown", options.scale_unknown,
            "the moving file's unit is not known: an overall factor from 0.1 to 10 is found, too")
      .basic();
}

PriorUncertainty PriorUncertainty::none() {
  PriorUncertainty uncertainty;
  uncertainty.translation = kAnywhere;
  uncertainty.heading_deg = 180.0;
  return uncertainty;
}

double logScaleLimit(const PriorUncertainty& uncertainty) {
  return -std::log(1.0 - uncertainty.scale);
}

}  // namespace agricolmap
