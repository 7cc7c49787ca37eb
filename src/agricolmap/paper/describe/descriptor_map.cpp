#include "agricolmap/paper/describe/descriptor_map.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::paper {

void listOptions(OptionTable& table, DescribeOptions& options) {
  map::listDataTerm(table, options.term);
  table.group("daisy", options.daisy);
  table.group("fpfh", options.fpfh);
}

namespace {

constexpr double kLeastDaisyRadius = 3.0;  ///< a cell for each ring

/// A rectangle of cells of a map.
struct Part {
  int row = 0;
  int col = 0;
  int rows = 0;
  int cols = 0;
};

Part partIn(const GridFrame& frame, const map::Box2& window) {
  const Eigen::Array2d low = (window.min() - frame.corner).array() / frame.cell;
  const Eigen::Array2d high = (window.max() - frame.corner).array() / frame.cell;
  const auto cut = [](double value, int limit) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(limit)));
  };
  Part part;
  part.row = cut(std::floor(low.y()), frame.rows);
  part.col = cut(std::floor(low.x()), frame.cols);
  part.rows = std::max(0, cut(std::ceil(high.y()), frame.rows) - part.row);
  part.cols = std::max(0, cut(std::ceil(high.x()), frame.cols) - part.col);
  return part;
}

template <typename Value>
MaskedRaster extract(const map::GridMap& map, const Part& part, const Value& value) {
  MaskedRaster out{Raster<float>(part.rows, part.cols), Raster<float>(part.rows, part.cols)};
  for (int row = 0; row < part.rows; ++row) {
    for (int col = 0; col < part.cols; ++col) {
      const std::size_t i = map.weight.index(row + part.row, col + part.col);
      if (!map.valid(i)) continue;
      out.weight(row, col) = 1.0F;
      out.value(row, col) = value(i);
    }
  }
  return out;
}

/// Channels of the data term at one resolution.
struct Channels {
  std::vector<MaskedRaster> visual;
  std::vector<MaskedRaster> height;  ///< none or one
};

Channels channelsOf(const map::GridMap& map, const Part& part, map::DataTerm term) {
  Channels channels;
  if (term == map::DataTerm::kRgb) {
    channels.visual = {
        extract(map, part, [&](std::size_t i) { return static_cast<float>(map.colour[i].r); }),
        extract(map, part, [&](std::size_t i) { return static_cast<float>(map.colour[i].g); }),
        extract(map, part, [&](std::size_t i) { return static_cast<float>(map.colour[i].b); })};
  } else if (term != map::DataTerm::kHeight) {
    channels.visual = {extract(map, part, [&](std::size_t i) { return map.exg[i]; })};
  }
  if (term == map::DataTerm::kExgHeight || term == map::DataTerm::kHeight) {
    channels.height = {extract(map, part, [&](std::size_t i) { return map.height[i]; })};
  }
  return channels;
}

DescriptorMap describeLevel(const Channels& channels, const GridFrame& frame,
                            const DescribeOptions& options) {
  DescriptorMap out;
  out.frame = frame;
  const std::size_t cells = static_cast<std::size_t>(frame.rows) * frame.cols;
  out.bytes.assign(cells * DescriptorMap::kStride, 0);
  out.known.assign(cells, 0);
  if (!channels.visual.empty()) computeDaisy(channels.visual, options.daisy, out);
  if (!channels.height.empty()) {
    computeFpfh(channels.height.front(), frame.cell, options.fpfh, out);
  }
  return out;
}

}  // namespace

std::vector<DescriptorMap> describeMap(const map::GridMap& map, const map::Box2& window, int levels,
                                       const DescribeOptions& options) {
  const Part part = partIn(map.frame, window);
  if (part.rows == 0 || part.cols == 0) return {};
  GridFrame frame = map.frame;
  frame.corner += frame.cell * Eigen::Vector2d(part.col, part.row);
  frame.rows = part.rows;
  frame.cols = part.cols;
  Channels channels = channelsOf(map, part, options.term);
  std::vector<DescriptorMap> result;
  for (int level = 0; level < levels; ++level) {
    if (level > 0) {
      for (auto* kind : {&channels.visual, &channels.height}) {
        for (MaskedRaster& channel : *kind) channel = halved(channel);
      }
      frame.cell *= 2.0;
      frame.rows = (frame.rows + 1) / 2;
      frame.cols = (frame.cols + 1) / 2;
    }
    DescribeOptions here = options;
    here.daisy.radius =
        std::max(kLeastDaisyRadius, options.daisy.radius * std::pow(options.daisy.shrink, level));
    result.push_back(describeLevel(channels, frame, here));
  }
  return result;
}

}  // namespace agricolmap::paper
