#include "agricolmap/crop/row_bands.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::crop {

namespace {

constexpr double kCore = 0.4;      // of the row's half width
constexpr double kBetween = 0.55;  // of the row spacing, from the line

/// The cells of one patch, taken off `leaf` from one of them on.
std::vector<std::size_t> takePatch(Raster<std::uint8_t>& leaf, std::size_t seed) {
  std::vector<std::size_t> patch = {seed};
  leaf[seed] = 0;
  const int cols = leaf.cols();
  for (std::size_t next = 0; next < patch.size(); ++next) {
    const auto row = static_cast<int>(patch[next] / static_cast<std::size_t>(cols));
    const auto col = static_cast<int>(patch[next] % static_cast<std::size_t>(cols));
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = col - 1; c <= col + 1; ++c) {
        if (!leaf.contains(r, c) || leaf(r, c) == 0) continue;
        leaf(r, c) = 0;
        patch.push_back(leaf.index(r, c));
      }
    }
  }
  return patch;
}

}  // namespace

RowBands rowBands(const GridFrame& frame, const FieldRows& field) {
  RowBands bands;
  bands.band = Raster<Band>(frame.rows, frame.cols, Band::kOutside);
  bands.row = Raster<std::int32_t>(frame.rows, frame.cols, -1);
  Raster<float> nearest(frame.rows, frame.cols, 1e9F);
  const double step = 0.7 * frame.cell;
  const int reach = static_cast<int>(std::ceil(kBetween * field.row_spacing / step));
  for (std::size_t i = 0; i < field.rows.size(); ++i) {
    const RowLine& line = field.rows[i].line;
    for (double s = 0.0; s <= line.length(); s += step) {
      const RowPlace place = line.at(s);
      for (int j = -reach; j <= reach; ++j) {
        const Eigen::Vector2d at = frame.cellOf(place.point + (j * step) * place.left());
        const int col = static_cast<int>(std::lround(at.x()));
        const int row = static_cast<int>(std::lround(at.y()));
        const auto aside = static_cast<float>(std::abs(j) * step);
        if (!nearest.contains(row, col) || aside >= nearest(row, col)) continue;
        nearest(row, col) = aside;
        bands.row(row, col) = static_cast<std::int32_t>(i);
        const auto from_line = static_cast<double>(aside);
        bands.band(row, col) = from_line <= kCore * field.half_width ? Band::kCore
                               : from_line <= field.half_width       ? Band::kRow
                                                                     : Band::kBetween;
      }
    }
  }
  return bands;
}

Weeds findWeeds(const GridFrame& frame, const Greenness& greenness, const RowBands& bands) {
  Weeds weeds;
  weeds.mask = Raster<std::uint8_t>(frame.rows, frame.cols);
  Raster<std::uint8_t> leaf(frame.rows, frame.cols);
  for (std::size_t i = 0; i < leaf.size(); ++i) leaf[i] = greenness.green[i] > greenness.leaf;
  for (std::size_t i = 0; i < leaf.size(); ++i) {
    if (leaf[i] == 0 || bands.band[i] != Band::kBetween) continue;
    const std::vector<std::size_t> patch = takePatch(leaf, i);
    if (patch.size() < kLeastPatchCells) continue;
    if (std::any_of(patch.begin(), patch.end(),
                    [&](std::size_t k) { return bands.band[k] == Band::kCore; })) {
      continue;
    }
    WeedPatch found;
    for (const std::size_t k : patch) {
      const std::size_t row = k / static_cast<std::size_t>(frame.cols);
      const std::size_t col = k % static_cast<std::size_t>(frame.cols);
      found.place += frame.centre(static_cast<double>(row), static_cast<double>(col)) /
                     static_cast<double>(patch.size());
    }
    const Eigen::Vector2d at = frame.cellOf(found.place);
    const int row = static_cast<int>(std::lround(at.y()));
    const int col = static_cast<int>(std::lround(at.x()));
    if (!bands.band.contains(row, col) || bands.band(row, col) != Band::kBetween) continue;
    found.area = frame.cell * frame.cell * static_cast<double>(patch.size());
    for (const std::size_t k : patch) weeds.mask[k] = 1;
    weeds.patches.push_back(found);
  }
  return weeds;
}

}  // namespace agricolmap::crop
