// The published data set, and folders laid out like it, as cases.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/pairs/cases.hpp"

namespace agricolmap::experiments {

/// One case for each pair below the folders, called `crop/row`, without what would part fields of a
/// row or of a table. Those without a truth are among them. Throws InputError where
/// findPublishedPairs does, and when two pairs have the same name.
std::vector<Case> publishedCases(const std::vector<std::filesystem::path>& dirs);

}  // namespace agricolmap::experiments
