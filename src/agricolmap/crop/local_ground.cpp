#include "agricolmap/crop/local_ground.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/robust.hpp"
#include "agricolmap/crop/row_line.hpp"

namespace agricolmap::crop {

namespace {

constexpr std::size_t kLeastBare = 12;  // cells of a square

/// Takes the mean of its known neighbours for each square that has none, again and again.
void fillSquares(Raster<float>& squares) {
  for (bool again = true; again;) {
    again = false;
    const Raster<float> before = squares;
    bool any = false;
    for (int r = 0; r < squares.rows(); ++r) {
      for (int c = 0; c < squares.cols(); ++c) {
        any = any || std::isfinite(before(r, c));
        if (std::isfinite(before(r, c))) continue;
        float sum = 0.0F;
        float count = 0.0F;
        for (int y = std::max(0, r - 1); y <= std::min(r + 1, squares.rows() - 1); ++y) {
          for (int x = std::max(0, c - 1); x <= std::min(c + 1, squares.cols() - 1); ++x) {
            if (!std::isfinite(before(y, x))) continue;
            sum += before(y, x);
            count += 1.0F;
          }
        }
        if (count > 0.0F) squares(r, c) = sum / count;
        again = again || count == 0.0F;
      }
    }
    if (!any) return;
  }
}

}  // namespace

Raster<float> heightAboveGround(const View& view, const Greenness& greenness,
                                const GroundOptions& options) {
  if (view.height.empty()) return {};
  const GridFrame& frame = view.frame;
  const int side = std::max(1, static_cast<int>(std::lround(options.tile / frame.cell)));
  GridFrame coarse = frame;
  coarse.cell = side * frame.cell;
  coarse.rows = (frame.rows + side - 1) / side;
  coarse.cols = (frame.cols + side - 1) / side;
  Raster<float> squares(coarse.rows, coarse.cols, kUnknown);
  const float bare = 0.5F * greenness.leaf;
  parallelFor(static_cast<std::size_t>(coarse.rows), [&](std::size_t item) {
    const int r = static_cast<int>(item);
    std::vector<float> heights;
    for (int c = 0; c < coarse.cols; ++c) {
      heights.clear();
      for (int y = r * side; y < std::min(frame.rows, (r + 1) * side); ++y) {
        for (int x = c * side; x < std::min(frame.cols, (c + 1) * side); ++x) {
          if (std::isfinite(view.height(y, x)) && greenness.green(y, x) < bare) {
            heights.push_back(view.height(y, x));
          }
        }
      }
      if (heights.size() >= kLeastBare) squares(r, c) = median(heights);
    }
  });
  fillSquares(squares);
  Raster<float> above = view.height;
  parallelFor(
      static_cast<std::size_t>(frame.rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < frame.cols; ++c) {
          if (std::isfinite(above(r, c))) {
            above(r, c) -= knownValue(coarse, squares, frame.centre(r, c));
          }
        }
      },
      16);
  return above;
}

}  // namespace agricolmap::crop
