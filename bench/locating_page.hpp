// docs/locating.md with its plots, from the rows of campaigns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign_table.hpp"
#include "logistic.hpp"

namespace agricolmap::campaign {

struct PageFile {
  std::string name;  ///< relative to the folder of the page
  std::string text;
};

/// The page and its pictures. `origins`: a line for each file of rows. Only rows of `preset` count.
std::vector<PageFile> locatingPage(const std::vector<PairRow>& rows,
                                   const std::vector<std::string>& origins,
                                   const std::string& preset);

/// `curve-<crop>-<series>=<value>`; nothing for other cases.
struct CurveName {
  std::string crop;
  std::string series;
  double value = 0.0;
};
std::optional<CurveName> parseCurveName(const std::string& case_name);

/// Probability that a chi-squared variable of 2 or 5 degrees of freedom is below `value`.
double chiSquaredBelow(double value, int degrees);

}  // namespace agricolmap::campaign
