// What the paper reports, on its real data.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace agricolmap::compare {

/// Tab. err_statistic: e_t / e_R / e_s of the successes at scale error number `scale` of 0, 5, …,
/// 30 %; `fail` where there were none, a dash where it gives no figure. Empty for a method or data
/// set that it does not have; semi-real strips have the figures of their crop, real pairs those of
/// the crop that their folder is called after.
std::string paperAccuracy(const std::string& dataset, const std::string& method, std::size_t scale);

/// Tab. inliers_percentage [%]. Empty where it has none.
std::string paperInliers(const std::string& dataset, const std::string& method);

/// Tab. timings_tab: min / max / avg [s]. Empty where it has none.
std::string paperTimes(const std::string& method);

/// Fig. correct_reg_rate without scale error, its values as released with the code: the share of
/// successes at the setting, or at the nearest one that there is. Empty where there is none.
std::string paperSuccess(const std::string& experiment, const std::string& method, double setting);

/// The same as numbers to draw: settings of ours with the paper's shares, in order; where it gives
/// a range, its middle.
std::vector<std::pair<double, double>> paperCurve(const std::string& experiment,
                                                  const std::string& method);

}  // namespace agricolmap::compare
