// What of the two maps is compared, in the flow's cost as in the correlation (paper Tab. IV).
#pragma once

#include "agricolmap/core/options.hpp"

namespace agricolmap::map {

enum class DataTerm {
  kExgHeight,  ///< Excess Green and height, the paper's choice
  kRgb,        ///< colour without height
  kExg,        ///< Excess Green alone
  kHeight,     ///< height alone
};

inline void listDataTerm(OptionTable& table, DataTerm& term) {
  table.choice("term", term, {"exg_height", "rgb", "exg", "height"},
               "what is compared: Excess Green and height, colour, or one of the two alone");
}

}  // namespace agricolmap::map
