// Pictures of a registration for people: what was compared, what was found, and how well it fits.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/verdict/evidence.hpp"

namespace agricolmap::report {

/// What the pictures say beside what the registration knows.
struct PictureInfo {
  std::string fixed_name = "fixed map";    ///< the cloud's, as the user gave it
  std::string moving_name = "moving map";  ///< likewise
  verdict::EvidenceOptions evidence;       ///< those the registration was judged with
};

/// Whether this build can draw; without Cairo, what follows throws UsageError.
bool canDraw();

/// Names of all files that writePictures may write, e.g. to clear those of an earlier run.
std::vector<std::string> pictureNames();

/// Writes PNG pictures into the existing folder `dir` and returns their names:
///  - exg_maps.png: the two maps' Excess Green (heights for clouds without colours),
///  - flow.png: where the guess puts the moving map, where the registration does, and the matches,
///  - overlay_before.png, overlay_after.png: both maps in complementary colours,
///  - blocks.png: what the blocks of the moving map say when placed alone,
///  - deformation.png: how the strip is bent, where a deformation is followed.
/// Without a transform only the first two. Throws OutputError.
std::vector<std::string> writePictures(const io::OutputPath& dir,
                                       const pipeline::Registration& registration,
                                       const PictureInfo& info = {});

}  // namespace agricolmap::report
