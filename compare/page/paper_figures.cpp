// All figures of the paper in one place. Tables are named as in its LaTeX source.
#include "page/paper_figures.hpp"

#include <array>
#include <cmath>
#include <string_view>

namespace agricolmap::compare {
namespace {

struct Accuracy {
  std::string_view crop;
  std::string_view method;
  std::array<std::string_view, 7> cells;
};

// Tab. err_statistic, "Registration accuracy comparison".
constexpr Accuracy kAccuracy[] = {
    {"soybean",
     "agricolmap",
     {"0.03 m / 0.03° / –", "0.03 m / 0.04° / 1.9 %", "0.04 m / 0.05° / 2.0 %",
      "0.04 m / 0.04° / 2.1 %", "0.03 m / 0.04° / 2.2 %", "0.05 m / 0.04° / 2.2 %",
      "0.05 m / 0.05° / 2.3 %"}},
    {"soybean",
     "icp-affine",
     {"0.03 m / 0.07° / –", "0.05 m / 0.08° / 2.4 %", "0.04 m / 0.09° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"soybean",
     "cpd-affine",
     {"0.02 m / 0.03° / –", "0.04 m / 0.07° / 2.1 %", "0.03 m / 0.08° / 2.3 %",
      "0.03 m / 0.08° / 2.4 %", "fail", "fail", "fail"}},
    {"soybean", "go-icp", {"0.03 m / 0.06° / –", "–", "–", "–", "–", "–", "–"}},
    {"soybean",
     "surf",
     {"0.02 m / 0.04° / –", "0.03 m / 0.04° / 2.2 %", "0.05 m / 0.06° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"soybean",
     "orb",
     {"0.02 m / 0.04° / –", "0.04 m / 0.04° / 2.2 %", "0.05 m / 0.05° / 2.3 %", "fail", "fail",
      "fail", "fail"}},
    {"soybean",
     "fast-brief",
     {"0.04 m / 0.05° / –", "0.05 m / 0.06° / 2.3 %", "0.05 m / 0.07° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-10m",
     "agricolmap",
     {"0.03 m / 0.04° / –", "0.03 m / 0.04° / 2.1 %", "0.04 m / 0.04° / 2.0 %",
      "0.05 m / 0.06° / 2.0 %", "0.05 m / 0.07° / 2.3 %", "0.05 m / 0.1° / 2.3 %",
      "0.05 m / 0.1° / 2.4 %"}},
    {"sugar-beet-10m",
     "icp-affine",
     {"0.04 m / 0.05° / –", "0.05 m / 0.07° / 2.1 %", "0.05 m / 0.09° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-10m",
     "cpd-affine",
     {"0.03 m / 0.04° / –", "0.04 m / 0.05° / 2.1 %", "0.04 m / 0.06° / 2.2 %",
      "0.05 m / 0.09° / 2.4 %", "fail", "fail", "fail"}},
    {"sugar-beet-10m", "go-icp", {"0.02 m / 0.05° / –", "–", "–", "–", "–", "–", "–"}},
    {"sugar-beet-10m",
     "surf",
     {"0.03 m / 0.04° / –", "0.03 m / 0.04° / 2.1 %", "0.04 m / 0.07° / 2.3 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-10m",
     "orb",
     {"0.02 m / 0.03° / –", "0.03 m / 0.03° / 2.2 %", "0.05 m / 0.06° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-10m",
     "fast-brief",
     {"0.02 m / 0.04° / –", "0.02 m / 0.03° / 2.1 %", "0.05 m / 0.06° / 2.3 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-20m",
     "agricolmap",
     {"0.03 m / 0.03° / –", "0.04 m / 0.03° / 2.0 %", "0.04 m / 0.04° / 2.2 %",
      "0.05 m / 0.05° / 2.1 %", "0.05 m / 0.08° / 2.2 %", "0.05 m / 0.09° / 2.4 %",
      "0.05 m / 0.1° / 2.4 %"}},
    {"sugar-beet-20m",
     "icp-affine",
     {"0.05 m / 0.06° / –", "0.05 m / 0.09° / 2.3 %", "fail", "fail", "fail", "fail", "fail"}},
    {"sugar-beet-20m",
     "cpd-affine",
     {"0.04 m / 0.05° / –", "0.05 m / 0.07° / 2.3 %", "0.05 m / 0.08° / 2.4 %",
      "0.05 m / 0.1° / 2.5 %", "fail", "fail", "fail"}},
    {"sugar-beet-20m", "go-icp", {"0.04 m / 0.05° / –", "–", "–", "–", "–", "–", "–"}},
    {"sugar-beet-20m",
     "surf",
     {"0.03 m / 0.04° / –", "0.04 m / 0.05° / 2.1 %", "0.04 m / 0.06° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-20m",
     "orb",
     {"0.04 m / 0.05° / –", "0.04 m / 0.05° / 2.2 %", "0.04 m / 0.05° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"sugar-beet-20m",
     "fast-brief",
     {"0.03 m / 0.04° / –", "0.04 m / 0.05° / 2.1 %", "0.05 m / 0.07° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"winter-wheat",
     "agricolmap",
     {"0.04 m / 0.02° / –", "0.04 m / 0.03° / 2.0 %", "0.04 m / 0.05° / 2.1 %",
      "0.04 m / 0.04° / 2.2 %", "0.05 m / 0.08° / 2.3 %", "0.05 m / 0.09° / 2.4 %",
      "0.05 m / 0.1° / 2.4 %"}},
    {"winter-wheat",
     "icp-affine",
     {"0.04 m / 0.07° / –", "0.04 m / 0.08° / 2.2 %", "0.05 m / 0.10° / 2.5 %", "fail", "fail",
      "fail", "fail"}},
    {"winter-wheat",
     "cpd-affine",
     {"0.04 m / 0.05° / –", "0.04 m / 0.05° / 1.9 %", "0.04 m / 0.05° / 2.1 %",
      "0.05 m / 0.09° / 2.3 %", "fail", "fail", "fail"}},
    {"winter-wheat", "go-icp", {"0.03 m / 0.07° / –", "–", "–", "–", "–", "–", "–"}},
    {"winter-wheat",
     "surf",
     {"0.03 m / 0.06° / –", "0.03 m / 0.05° / 2.2 %", "0.04 m / 0.06° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
    {"winter-wheat",
     "orb",
     {"0.04 m / 0.05° / –", "0.04 m / 0.04° / 2.1 %", "0.04 m / 0.06° / 2.3 %", "fail", "fail",
      "fail", "fail"}},
    {"winter-wheat",
     "fast-brief",
     {"0.03 m / 0.07° / –", "0.04 m / 0.06° / 2.3 %", "0.05 m / 0.05° / 2.4 %", "fail", "fail",
      "fail", "fail"}},
};

struct Inliers {
  std::string_view crop;
  std::string_view method;
  std::string_view percent;
};

// Tab. inliers_percentage, "Inliers percentage comparison when changing data terms". One sugar
// beet.
constexpr Inliers kInliers[] = {
    {"soybean", "agricolmap-rgb", "11.7 ± 4.3"},
    {"soybean", "agricolmap-exg", "53.2 ± 14.9"},
    {"soybean", "agricolmap-height", "0.2 ± 0.1"},
    {"soybean", "agricolmap", "54.5 ± 13.2"},
    {"sugar-beet", "agricolmap-rgb", "49.2 ± 11.9"},
    {"sugar-beet", "agricolmap-exg", "64.1 ± 12.8"},
    {"sugar-beet", "agricolmap-height", "0.4 ± 0.2"},
    {"sugar-beet", "agricolmap", "68.1 ± 13.6"},
    {"winter-wheat", "agricolmap-rgb", "22.9 ± 9.7"},
    {"winter-wheat", "agricolmap-exg", "51.8 ± 17.4"},
    {"winter-wheat", "agricolmap-height", "0.1 ± 0.1"},
    {"winter-wheat", "agricolmap", "52.4 ± 16.7"},
};

struct Times {
  std::string_view method;
  std::string_view seconds;
};

// Tab. timings_tab, "Runtime comparison": min / max / avg over 100 successful registrations.
constexpr Times kTimes[] = {
    {"agricolmap", "63.7 / 118.6 / 79.8"}, {"icp-affine", "2.1 / 10.6 / 4.5"},
    {"cpd-affine", "4.9 / 23.2 / 8.2"},    {"go-icp", "5.3 / 689.2 / 193.1"},
    {"surf", "4.6 / 7.2 / 5.3"},           {"orb", "3.9 / 6.7 / 4.8"},
    {"fast-brief", "3.7 / 6.4 / 4.5"},
};

struct Success {
  std::string_view experiment;
  std::string_view method;
  double setting;  ///< of ours that it stands beside
  std::string_view text;
  double share;  ///< to draw: the middle where the text has a range
};

// Fig. correct_reg_rate, left column (no scale error), values as released with the authors' code.
constexpr Success kSuccess[] = {
    {"translation", "agricolmap", 5.0, "0.96", 0.96},
    {"translation", "agricolmap", 7.0, "0 (5.25 m)", 0},
    {"translation", "cpd-affine", 0.05, "0.96", 0.96},
    {"translation", "cpd-affine", 0.13, "0.34 (15 cm)", 0.34},
    {"translation", "cpd-affine", 0.25, "0.02", 0.02},
    {"translation", "icp-affine", 0.05, "0.97", 0.97},
    {"translation", "icp-affine", 0.13, "0.07 (15 cm)", 0.07},
    {"translation", "icp-affine", 0.25, "0", 0},
    {"translation", "go-icp", 0.25, "0.98", 0.98},
    {"translation", "go-icp", 1.0, "0.79", 0.79},
    {"translation", "go-icp", 2.0, "0", 0},
    {"translation", "surf", 5.0, "0.82–0.88", 0.85},
    {"translation", "orb", 5.0, "0.82–0.88", 0.85},
    {"translation", "fast-brief", 5.0, "0.82–0.88", 0.85},
    {"heading", "agricolmap", 0.2, "0.01–0.07", 0.04},
};

/// The paper's crop that the folder of a real pair is called after; empty when it is not one. A
/// beet field without its flying height has the figures that the paper gives for both.
std::string_view namedCrop(std::string_view folder) {
  std::string name;  // "Sugar Beet_10 m" is "sugarbeet10m"
  for (const char c : folder) {
    if (c >= 'A' && c <= 'Z') name += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) name += c;
  }
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  if (has("soy")) return "soybean";
  if (has("wheat")) return "winter-wheat";
  if (!has("beet")) return {};
  if (has("10m")) return "sugar-beet-10m";
  return has("20m") ? "sugar-beet-20m" : "sugar-beet";
}

/// The paper's crop that a data set stands for.
std::string_view cropOf(std::string_view dataset) {
  if (dataset == "semireal-sugarbeet") return "sugar-beet-10m";
  if (dataset == "real-soybean") return "soybean";
  const std::size_t slash = dataset.rfind('/');
  return slash == std::string_view::npos ? dataset : namedCrop(dataset.substr(0, slash));
}

}  // namespace

std::string paperAccuracy(const std::string& dataset, const std::string& method,
                          std::size_t scale) {
  for (const Accuracy& row : kAccuracy) {
    if (row.crop != cropOf(dataset) || row.method != method) continue;
    return scale < row.cells.size() ? std::string(row.cells[scale]) : std::string();
  }
  return {};
}

std::string paperInliers(const std::string& dataset, const std::string& method) {
  for (const Inliers& row : kInliers) {
    if (cropOf(dataset).starts_with(row.crop) && row.method == method) {
      return std::string(row.percent);
    }
  }
  return {};
}

std::vector<std::pair<double, double>> paperCurve(const std::string& experiment,
                                                  const std::string& method) {
  std::vector<std::pair<double, double>> curve;
  for (const Success& row : kSuccess) {
    if (row.experiment == experiment && row.method == method) {
      curve.emplace_back(row.setting, row.share);
    }
  }
  return curve;
}

std::string paperTimes(const std::string& method) {
  for (const Times& row : kTimes) {
    if (row.method == method) return std::string(row.seconds);
  }
  return {};
}

std::string paperSuccess(const std::string& experiment, const std::string& method, double setting) {
  for (const Success& row : kSuccess) {
    if (row.experiment == experiment && row.method == method &&
        std::abs(row.setting - setting) < 1e-9) {
      return std::string(row.text);
    }
  }
  return {};
}

}  // namespace agricolmap::compare
