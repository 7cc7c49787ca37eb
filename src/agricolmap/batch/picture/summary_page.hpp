// summary.html: a batch for people, with the way to the report of each strip.
#pragma once

#include <span>
#include <string>

#include "agricolmap/batch/record.hpp"

namespace agricolmap::batch {

/// The whole page: it lies beside the strips' folders, which it leads to.
std::string summaryPage(std::span<const Record> records, const Manifest& manifest, double seconds);

}  // namespace agricolmap::batch
