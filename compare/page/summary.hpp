// Where the default preset is ahead and where it is not, in words.
#pragma once

#include <string>
#include <vector>

#include "runner/rows.hpp"

namespace agricolmap::compare {

/// Three sentences, from the rows alone.
std::string summarySentences(const std::vector<Row>& rows);

}  // namespace agricolmap::compare
