#include "agricolmap/fuse/options.hpp"

namespace agricolmap::fuse {

void listOptions(OptionTable& table, FuseOptions& options) {
  table
      .number("cell", options.cell, 0.0, 1.0, "m",
              "side of a cell of the layers; 0: so that the fixed cloud fills them")
      .basic();
  table.number("least_seen", options.least_seen, 0.01, 1.0, "",
               "a cell is a strip's where it has this share of the strip's usual number of points");
  table
      .number("seam", options.seam, 0.0, 10.0, "m",
              "over how far the fixed cloud's heights are led to those of a strip")
      .basic();
  table
      .flag("match_colours", options.match_colours,
            "bring the strips' colours to the fixed cloud's")
      .basic();
  table
      .flag("correct_heights", options.correct_heights,
            "correct the fixed cloud's heights over plants by what strips show of them")
      .basic();
  table
      .flag("adjust", options.adjust,
            "move strips that overlap to where they agree best, within their errors")
      .basic();
}

}  // namespace agricolmap::fuse
