// Real pairs, the data set of the paper or one's own, in the folders of docs/published-data.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/pairs/cases.hpp"

namespace agricolmap::experiments {

/// One case for each row's cloud below the folders, in order of their names, called `crop/row`
/// without what would part fields of a row or of a table. Those without a truth are among them.
/// Clouds are not read. Throws InputError, which says what to change, where folders are not as they
/// should be, when there is no pair, and when two have the same name.
std::vector<Case> publishedCases(const std::vector<std::filesystem::path>& dirs);

/// What tells a pair from another with the same name: files, their sizes and the truth, but not
/// where they lie. Throws InputError for a file that is gone.
std::string publishedText(const PublishedPair& pair);

}  // namespace agricolmap::experiments
