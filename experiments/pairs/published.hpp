// The data set of the paper, as its folders lie on a user's disk.
//
// For each cloud there is a folder with `point_cloud.ply` and `offset.xyz`; the ground truth of a
// row is one line of 12 numbers (3×4 affine, row-major) and 2 relative scales. What the folders are
// called is not known here, so that this much is accepted:
//
//   DIR/<crop>/<... uav ...>/point_cloud.ply, offset.xyz     the drone's cloud ("uav", "aerial")
//   DIR/<crop>/<... ugv ...>/point_cloud.ply, offset.xyz     a row ("ugv", "ground", "row")
//   DIR/<crop>/<... ugv ...>/<... truth ...>.txt             its truth ("truth", "affine"), or
//   DIR/<crop>/<... truth ... row 3 ...>.txt                 one folder up, see PublishedPair
//
// - A cloud's folder is one to three folders below DIR; <crop> may be DIR itself, or two deep.
//   Capitals do not matter; a name with "uav" or "aerial" is the drone's whatever else it has.
//   Links are followed; hidden folders are not looked into.
// - Several drone's clouds in one folder are several crops if names say which rows are whose: they
//   must be equal but for the words above and the numbers after them ("beet-uav", "beet-ugv-row2").
// - `agricolmap simulate -o DIR/<crop>` makes such a folder.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace agricolmap::experiments {

/// A row of a crop and the drone's cloud that it belongs to.
struct PublishedPair {
  std::string crop;  ///< the folder that holds the clouds, relative to the data set's
  std::string row;   ///< the row's own folder
  std::filesystem::path fixed_cloud;
  std::filesystem::path moving_cloud;
  std::optional<Eigen::Affine3d> world_from_fixed;   ///< offset.xyz, where there is one
  std::optional<Eigen::Affine3d> world_from_moving;  ///< likewise
  /// Beside the row's cloud; else one folder up, where its name must have the row's folder name or
  /// the row's number ("row 3", "row_03", "row3"), unless there is one row and one truth. Where
  /// several crops share a folder, the number alone does not do.
  std::optional<std::filesystem::path> truth_file;
  /// What that file says, moving file → fixed file coordinates: 12 + 2 numbers or a 4×4 matrix.
  std::optional<Eigen::Affine3d> true_fixed_from_moving;
};

/// All pairs below `dir`, sorted by crop and row. Clouds are not read. Throws InputError, which
/// says what to change, when there is no pair, when a row has no drone's cloud or a drone's cloud
/// no row, when a crop has two drone's clouds, and when an offset or a truth is ambiguous or of the
/// wrong shape.
std::vector<PublishedPair> findPublishedPairs(const std::filesystem::path& dir);

/// What tells a pair from another with the same names: files, their sizes and the truth, but not
/// where they lie. Throws InputError for a file that is gone.
std::string publishedText(const PublishedPair& pair);

}  // namespace agricolmap::experiments
