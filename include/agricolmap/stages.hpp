// The stages of a registration one by one, for those who look between them or bring places of their
// own. registerClouds runs them all, searches again where the first search does not convince, and
// places long strips piece by piece.
#pragma once

#include <memory>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/maps.hpp"
#include "agricolmap/options.hpp"
#include "agricolmap/register.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// Where the moving cloud may lie.
struct Place {
  Transform fixed_from_moving = Transform::Identity();  ///< file coordinates [m]
  double score = 0.0;  ///< larger is better; comparable among places of one call
};

/// Two clouds levelled, drawn as maps and made comparable: the stages level, grid and signals. All
/// members can be called by several threads at once.
class AGRICOLMAP_EXPORT Pair {
 public:
  /// Arguments as those of registerClouds; the clouds are kept, and neither may be null. Throws as
  /// it does, and UsageError where the scale of the moving cloud is unknown.
  Pair(std::shared_ptr<const Cloud> fixed, std::shared_ptr<const Cloud> moving,
       const Transform& guess, const Options& options = Options(), const Control& control = {});
  Pair(Pair&& other) noexcept;
  Pair& operator=(Pair&& other) noexcept;
  ~Pair();

  /// What is compared. The moving map lies where the guess lays it.
  ComparedMaps maps() const;
  /// The stage locate: places within the prior's limits, best first; none where nothing coherent
  /// was found.
  std::vector<Place> locate(const Control& control = {}) const;
  /// The stage refine: the places that hold, each led on to the finest cells, most significant
  /// first; what ran to one and the same place is one.
  std::vector<Place> refine(const std::vector<Place>& places, const Control& control = {}) const;
  /// The stages from refine to compose: the best of the places, judged beside the others. Of a
  /// single one nothing is known of rivals; decoys are looked for all the same.
  Registration judge(const std::vector<Place>& places, const Control& control = {}) const;

 private:
  struct Inside;
  std::unique_ptr<const Inside> inside_;
};

}  // namespace agricolmap
