// What the pictures of one registration share: maps ready to draw, the strip and where it lies.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/report/draw/map_layer.hpp"
#include "agricolmap/report/draw/page.hpp"
#include "agricolmap/report/draw/view.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap::report {

/// How green (or high) a value is: 0 at `low`, 1 at `high`.
struct ValueRange {
  double low = 0.0;
  double high = 1.0;
  float strength(float value) const {
    const float share = (value - static_cast<float>(low)) / static_cast<float>(high - low);
    return share < 0.0F ? 0.0F : share > 1.0F ? 1.0F : share;
  }
};

class Scene {
 public:
  /// Refers to its arguments, which must outlive it.
  Scene(const pipeline::Registration& registration, const PictureInfo& info);

  const pipeline::Registration& registration;
  const PictureInfo& info;
  PictureValue value;  ///< heights for clouds without colours
  MapLayer fixed;
  MapLayer moving;
  /// The moving map without the deformation that is followed, where one is.
  std::optional<MapLayer> straight;
  /// Soil is 0 and vegetation 1, each by its own map: cameras differ.
  ValueRange fixed_range;
  ValueRange moving_range;
  std::vector<Eigen::Vector2d> outline;  ///< corners of the moving map, levelled moving frame [m]
  GroundRect strip;                      ///< the smallest rectangle around it
  GroundRect block_strip;                ///< the one that the evidence's blocks are cut along
  /// Middles of two places near the strip's ends with much to see, levelled moving frame [m].
  std::array<Eigen::Vector2d, 2> insets;

  const char* valueName() const { return value == PictureValue::kExg ? "Excess Green" : "Height"; }
  /// Turned like the strip as `pose` lays it, the rectangle around its outline.
  GroundRect stripUnder(const Eigen::Affine2d& pose) const;
  /// The outline as `pose` lays it.
  std::vector<Eigen::Vector2d> outlineUnder(const Eigen::Affine2d& pose) const;
  /// The matches that the pose was estimated from; empty where a search found it as a whole.
  const std::vector<Match>& winningMatches() const;
};

/// Paints the fixed map for what is drawn over it: `pixel(strength)` where it is known, else
/// hatched.
template <typename Pixel>
void paintGround(PictureCanvas& canvas, const Scene& scene, const View& view, const Pixel& pixel) {
  LayerRow row(scene.fixed, Eigen::Affine2d::Identity(), view);
  canvas.paint(view.rect, [&](int y, std::uint32_t* out) {
    row.sample(y);
    for (int i = 0; i < view.rect.width; ++i) {
      out[i] = row.seen(i) > 0.5F ? pixel(scene.fixed_range.strength(row.value(i)))
                                  : darkHatch(view.rect.x + i, y);
    }
  });
}

/// Side of the insets [m].
inline constexpr double kInsetSide = 2.0;

/// How far and how turned and stretched the registration moved the moving map, in one line.
std::string describeMove(const pipeline::Registration& registration);

}  // namespace agricolmap::report
