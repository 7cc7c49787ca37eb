// comparison.html and docs/comparison.md from the rows.
#pragma once

#include <string>
#include <vector>

#include "page/document.hpp"
#include "runner/rows.hpp"

namespace agricolmap::compare {

/// All of it. `identity`: the origin of the rows in one line;
Document comparisonDocument(const std::vector<Row>& rows, const std::string& identity);

/// The plots of success over translation and heading error.
std::vector<Figure> successFigures(const std::vector<Row>& rows);

}  // namespace agricolmap::compare
