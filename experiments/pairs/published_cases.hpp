// The published data set, and folders laid out like it, as data sets of the comparison.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/datasets.hpp"

namespace agricolmap::experiments {

/// One data set for each pair below the folders, called `crop/row`, without what would part fields
/// of a row or of a table. Those without a truth are among them. Throws InputError where
/// findPublishedPairs does, and when two pairs have the same name.
std::vector<DataSet> publishedDataSets(const std::vector<std::filesystem::path>& dirs);

/// What tells the real data among `sets` from other data with the same names: files, their sizes
/// and the truths, but not where they lie. Empty when none is real. Throws InputError.
std::string publishedText(const std::vector<DataSet>& sets);

}  // namespace agricolmap::experiments
