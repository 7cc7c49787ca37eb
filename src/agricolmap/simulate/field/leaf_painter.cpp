#include "agricolmap/simulate/field/leaf_painter.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::simulate {

/// One surface to draw, in window coordinates [m].
struct LeafPainter::Ribbon {
  Eigen::Vector3f base;
  float azimuth = 0.0F;
  float elevation = 0.0F;
  float bend = 0.0F;
  float length = 0.0F;
  float half_width = 0.0F;
  float roll = 0.0F;
  LeafShape shape = LeafShape::kOval;
  std::array<float, 3> albedo{};
};

LeafPainter::LeafPainter(Canvas& canvas, const Tile& tile, const Eigen::Vector3f& sun_in_window)
    : canvas_(&canvas),
      tile_(tile),
      sun_(sun_in_window),
      heading_(static_cast<float>(canvas.window.heading)),
      cell_(static_cast<float>(canvas.window.cell)) {}

namespace {

/// Half width at t in [0, 1] over the greatest.
float profile(LeafShape shape, float t) {
  switch (shape) {
    case LeafShape::kOval:
    case LeafShape::kTrifoliate: {
      const float s = 2.0F * t - 0.9F;
      return std::sqrt(std::max(0.0F, 1.0F - s * s * (s > 0.0F ? 0.83F : 1.0F)));
    }
    case LeafShape::kBlade:
      return std::min(1.0F, 0.35F + 4.0F * t) * std::sqrt(std::max(0.0F, 1.0F - t));
    case LeafShape::kStraw:
      return 1.0F;
  }
  return 0.0F;
}

/// End of a rod of the given length that bends down on its way.
Eigen::Vector3f alongRod(const Eigen::Vector3f& base, float azimuth, float elevation,
                         float length) {
  return base + length * Eigen::Vector3f(std::cos(elevation) * std::cos(azimuth),
                                         std::cos(elevation) * std::sin(azimuth),
                                         std::sin(elevation));
}

}  // namespace

void LeafPainter::paintRibbon(const Ribbon& ribbon) {
  const float step = 0.75F * cell_;
  const int steps = std::max(1, static_cast<int>(std::ceil(ribbon.length / step)));
  const float ds = ribbon.length / static_cast<float>(steps);
  const float ca = std::cos(ribbon.azimuth);
  const float sa = std::sin(ribbon.azimuth);
  const float cr = std::cos(ribbon.roll);
  const float sr = std::sin(ribbon.roll);
  const std::array<std::uint8_t, 3> albedo = {encodeAlbedo(ribbon.albedo[0]),
                                              encodeAlbedo(ribbon.albedo[1]),
                                              encodeAlbedo(ribbon.albedo[2])};
  // The direction of the axis turns by a constant angle per step.
  float ce = std::cos(ribbon.elevation);
  float se = std::sin(ribbon.elevation);
  const float turn_c = std::cos(ribbon.bend / static_cast<float>(steps));
  const float turn_s = std::sin(ribbon.bend / static_cast<float>(steps));
  Eigen::Vector3f p = ribbon.base;
  const float to_cell = 1.0F / cell_;
  for (int i = 0; i < steps; ++i) {
    const float t = (static_cast<float>(i) + 0.5F) / static_cast<float>(steps);
    p += ds * Eigen::Vector3f(ce * ca, ce * sa, se);
    // Across the leaf, rolled about its axis; the normal completes the pair.
    const Eigen::Vector3f across(-sa * cr - se * ca * sr, ca * cr - se * sa * sr, ce * sr);
    const Eigen::Vector3f facing(sa * sr - se * ca * cr, -ca * sr - se * sa * cr, ce * cr);
    const float cosine = std::abs(facing.dot(sun_));
    const auto light =
        static_cast<std::uint8_t>(1.0F + 254.0F * std::min(1.0F, 0.15F + 0.85F * cosine));
    const float half = ribbon.half_width * profile(ribbon.shape, t);
    const int side = static_cast<int>(std::ceil(half / step - 0.3F));
    const float dw = side > 0 ? half / static_cast<float>(side) : 0.0F;
    for (int k = -side; k <= side; ++k) {
      const Eigen::Vector3f q = p + (static_cast<float>(k) * dw) * across;
      const int col = static_cast<int>(std::floor(q.x() * to_cell));
      const int row = static_cast<int>(std::floor(q.y() * to_cell));
      if (col < tile_.col0 || col >= tile_.col1 || row < tile_.row0 || row >= tile_.row1) continue;
      Cell& cell = canvas_->cells(row, col);
      if (q.z() <= cell.z) continue;
      cell.z = q.z();
      cell.albedo = albedo;
      cell.light = light;
    }
    const float next_c = ce * turn_c + se * turn_s;
    se = se * turn_c - ce * turn_s;
    ce = next_c;
  }
}

void LeafPainter::paintLeaf(const Leaf& leaf, const Eigen::Vector3f& base,
                            const std::array<float, 3>& albedo) {
  Ribbon ribbon;
  ribbon.base = base;
  ribbon.azimuth = leaf.azimuth - heading_;
  ribbon.elevation = leaf.elevation;
  ribbon.bend = leaf.bend;
  ribbon.roll = leaf.roll;
  ribbon.shape = leaf.shape;
  ribbon.albedo = albedo;
  const float stalk = leaf.stalk * leaf.length;
  if (stalk > 0.0F) {
    Ribbon stem = ribbon;
    stem.shape = LeafShape::kStraw;
    stem.length = stalk;
    stem.bend = 0.0F;
    stem.half_width = 0.04F * leaf.width;
    for (float& a : stem.albedo) a *= 1.25F;
    paintRibbon(stem);
    ribbon.base = alongRod(base, ribbon.azimuth, leaf.elevation, stalk);
  }
  ribbon.length = leaf.length - stalk;
  ribbon.half_width = 0.5F * leaf.width;
  if (leaf.shape != LeafShape::kTrifoliate) {
    paintRibbon(ribbon);
    return;
  }
  // Three leaflets that lie flatter than the stalk.
  ribbon.elevation = 0.3F * (leaf.elevation - 0.5F);
  for (const float turn : {0.0F, 1.35F, -1.35F}) {
    Ribbon leaflet = ribbon;
    leaflet.azimuth += turn;
    leaflet.roll = turn == 0.0F ? leaf.roll : leaf.roll + 0.2F * turn;
    paintRibbon(leaflet);
  }
}

void LeafPainter::paint(const Plant& plant, const Foliage& foliage, float soil) {
  const Eigen::Vector2f place = canvas_->window.local(plant.position.cast<double>()).cast<float>();
  const Eigen::Matrix2f turn = Eigen::Rotation2Df(-heading_).toRotationMatrix();
  for (int i = 0; i < foliage.count; ++i) {
    const Leaf& leaf = foliage.leaves[static_cast<std::size_t>(i)];
    const Eigen::Vector2f moved = place + turn * leaf.shift;
    paintLeaf(leaf, {moved.x(), moved.y(), soil + leaf.base_z}, foliage.albedoOf(leaf));
  }
}

}  // namespace agricolmap::simulate
