// The stages of a registration, in order. Folders, comments, times and documents call them by these
// names; the sections are those of the paper.
#pragma once

#include <array>
#include <string_view>

namespace agricolmap {

enum class Stage {
  kRead,      ///< files to clouds
  kLevel,     ///< gravity and ground: Sec. II, assumption 5
  kGrid,      ///< multimodal grid maps: Sec. III-A
  kSignals,   ///< the grid maps made comparable: high-passed, whitened; not in the paper
  kLocate,    ///< where may the moving map lie? Sec. III-B, or the correlation search
  kDescribe,  ///<   of the paper's way: DAISY and FPFH
  kFlow,      ///<   coarse-to-fine PatchMatch
  kVote,      ///<   the coherent part of the flow
  kRefine,    ///< the preliminary affine (Eq. 3) and CPD of Sec. IV, or the dense refinement
  kHeights,   ///< tilt and height from the ground that both maps see
  kDeform,    ///< the bends and slips of the strip: assumption 4 of Sec. II
  kJudge,     ///< evidence, uncertainty, probability, verdict; not in the paper
  kCompose,   ///< levelled frames back to those of the files
  kWrite,     ///< results to files
  kPictures,  ///< and to pictures
};

inline constexpr std::size_t kStages = 15;

/// As in `times` of registration.json.
constexpr std::string_view nameOf(Stage stage) {
  constexpr std::array<std::string_view, kStages> kNames = {
      "read",   "level",   "grid",   "signals", "locate",  "describe", "flow",    "vote",
      "refine", "heights", "deform", "judge",   "compose", "write",    "pictures"};
  return kNames[static_cast<std::size_t>(stage)];
}

}  // namespace agricolmap
