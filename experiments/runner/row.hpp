// One row per run: what a method came to on a pair, in one setting. This is the only definition of
// rows.csv; `experiments/analysis` reads it.
//
// The file: UTF-8, a header line with the names below in this order, one row per line, comma
// between fields, no quotes (in texts a comma becomes a semicolon, a line end a space). Numbers
// that do not exist are empty, flags 0 or 1. Files of several folders may be put together: each row
// says which source and options it is from.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace agricolmap::experiments {

inline constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// The columns are called as the members. Lengths in metres, times in seconds, angles in radians,
/// scales relative (0.1: 10 %). What cases should reach stands in analysis/targets.csv.
struct Row {
  // What was run.
  std::string suite;      ///< one of `agricolmap_experiments list suites`
  std::string settings;   ///< develop, calibrate or final: disjoint ways in which pairs may differ
  std::string case_name;  ///< kind of pair: one of `agricolmap_experiments list cases`
  std::string dataset;    ///< crop or imagery that the pair is of, such as sugar-beet-10m
  std::string kind;  ///< simulated, semi-real (strips of real imagery) or real (two real clouds)
  int seed = 0;      ///< of the pair
  /// What the suite varies: error of the guess [m], [rad], share or scale of it (translation,
  /// heading, joint, accuracy), value of the option (curves).
  double setting = 0.0;
  double guess_scale = 0.0;  ///< scale error that the suite adds to the moving cloud's x and y
  int field = 0;             ///< pairs of one field are not independent: keep them in one fold
  bool negative = false;     ///< the clouds have nothing in common: no answer can be right
  /// How wrong the guess is [m]: exactly, or at most, where the case draws it (no guess,
  /// --uniform).
  double guess_translation = kNotKnown;
  double guess_heading = kNotKnown;  ///< likewise [rad]
  /// How wrong the method is told that it may be: `T_M;HEADING_DEG;SCALE_%`, or `none` for no
  /// guess; with `;unit` where the file's unit is unknown.
  std::string told;
  std::string method;  ///< preset, preset with options (`default:grid.cell=0.03`), or peer
  int threads = 0;     ///< that it might use

  // What came of it.
  /// accepted; rejected or ambiguous (a transform that the method does not stand by); failed (no
  /// transform); skipped (not run: cannot be right, see `message`).
  std::string status;
  bool accepted = false;  ///< the method stands by its transform
  /// Within the paper's limits: RMS and e_t 5 cm, e_r 0.1, e_s 0.025; where a deformation is
  /// followed, the points within 5 cm RMS.
  bool right = false;
  bool right_in_plane = false;  ///< horizontal RMS within 5 cm, whatever the height
  // Errors of the transform; empty without one.
  double rms = kNotKnown;  ///< displacement over the moving points, drift included [m]
  double rms_horizontal = kNotKnown;
  double rms_vertical = kNotKnown;
  /// Of the points as they are laid: by transform and deformation, or by the transform alone.
  double aligned_rms = kNotKnown;             ///< heights included [m]
  double aligned_rms_horizontal = kNotKnown;  ///< [m]
  /// What the best affine of all points leaves, heights included [m]: drift and slips.
  double best_affine_rms = kNotKnown;
  double worst = kNotKnown;               ///< largest displacement of a point [m]
  double rms_to_best_affine = kNotKnown;  ///< horizontal, without what no affine can follow [m]
  double e_t = kNotKnown;                 ///< the paper's errors: translation [m],
  double e_r = kNotKnown;                 ///< rotation [rad],
  double e_s = kNotKnown;                 ///< norm of those of the two scales

  // What the product followed beside the transform; empty where nothing.
  double bend_gain = kNotKnown;   ///< by which left-out blocks confirm it [standard errors]
  double slips = kNotKnown;       ///< of which so many are slips
  double slip_place = kNotKnown;  ///< from a true slip to the nearest found, of the worst [m]
  /// Share of places within the 90 % ellipse that is stated for each.
  double places_covered = kNotKnown;

  // What the product states of its answer; empty for peers.
  double plane_probability = kNotKnown;  ///< of being within 5 cm RMS in the plane
  double place_probability = kNotKnown;  ///< of being the right place, however exact
  // The facts that the probabilities rest on (verdict/probability.hpp).
  double uniqueness = kNotKnown;
  double significance = kNotKnown;
  double decoy = kNotKnown;
  double agreeing = kNotKnown;  ///< blocks that agree,
  double blocks = kNotKnown;    ///< of so many that can be compared
  double expected_rms = kNotKnown;
  double systematic_rms =
      kNotKnown;                   ///< part of that which plants and soil contradict one another by
  double scatter_rms = kNotKnown;  ///< what blocks differ by,
  double local_rms = kNotKnown;    ///< and what neighbours among them share of that [m]
  double height_deviation = kNotKnown;  ///< stated [m]; empty without heights
  double heights_limited = kNotKnown;   ///< 1: heights are not believed, 0: they are
  double overlap = kNotKnown;
  // Further figures.
  double block_rms = kNotKnown;    ///< offsets of the agreeing blocks [m]
  double correlation = kNotKnown;  ///< at the end of the dense refinement
  double attempts = kNotKnown;     ///< searches until this answer
  // Whether it errs by as much as it states: squared Mahalanobis distances of the truth. Within the
  // 90 % ellipse below 9.236 (five horizontal parameters), 4.605 (the strip's centre), 2.706 (mean
  // height).
  double pose_mahalanobis2 = kNotKnown;
  double centre_mahalanobis2 = kNotKnown;
  double height_mahalanobis2 = kNotKnown;
  // How far off the strip's centre lies in the fixed map's plane, and what is stated of that [m].
  double centre_error_x = kNotKnown;
  double centre_error_y = kNotKnown;
  double centre_deviation_x = kNotKnown;
  double centre_deviation_y = kNotKnown;
  double centre_correlation = kNotKnown;  ///< of the two
  double height_error = kNotKnown;        ///< by how much the strip lies too high, on average [m]

  // Of methods that match points: all matches, those within 4 cm of the truth, those that the
  // method took for coherent; and of a second matching from what the first gave.
  double matches = kNotKnown;
  double matches_right = kNotKnown;
  double matches_coherent = kNotKnown;
  double rematches = kNotKnown;
  double rematches_right = kNotKnown;
  double rematches_coherent = kNotKnown;

  // What it cost.
  double fixed_points = kNotKnown;
  double moving_points = kNotKnown;
  double make_s = kNotKnown;  ///< making the pair, once for all runs on it
  double run_s = kNotKnown;   ///< the registration
  double cpu_s = kNotKnown;   ///< of all threads
  std::string stages;         ///< `name=seconds` parted by semicolons

  std::string message;  ///< why there is no accepted transform
  std::string source;   ///< commit of the sources, `+hash` of changes that are not committed
  std::string options;  ///< hash of case, method's options, limits and real files

  /// The answer is right and the method stands by it.
  bool success() const { return accepted && right; }
  /// Names the run: suite, settings, case, seed, setting, guess_scale and method. No file has two
  /// rows of one name.
  std::string key() const;
};

/// A column and the member that it holds.
struct Column {
  const char* name;
  std::variant<std::string Row::*, int Row::*, bool Row::*, double Row::*> member;
};
const std::vector<Column>& columns();
/// The member of a number's column. Throws Error for a name that is none's.
double Row::*numberColumn(std::string_view name);

std::string csvHeader();
/// With its line end.
std::string toCsv(const Row& row);
/// Reads what `toCsv` writes. `place` names the line in messages; throws InputError.
Row rowFromCsv(std::string_view line, const std::string& place);

}  // namespace agricolmap::experiments
