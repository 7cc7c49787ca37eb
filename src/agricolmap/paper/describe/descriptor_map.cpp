#include "agricolmap/paper/describe/descriptor_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, DescribeOptions& options) {
  map::listDataTerm(table, options.term);
  table.choice(
      "empty", options.empty, {"masked", "zero"},
      "cells without points: left out of the descriptors around them, or 0 as in the paper");
  table.number("max_memory", options.max_memory, 0.001, 1024.0, "GiB",
               "that describing one map may take; larger maps are refused");
  table.group("daisy", options.daisy);
  table.group("fpfh", options.fpfh);
}

namespace {

constexpr double kLeastDaisyRadius = 3.0;  ///< a cell for each ring
/// Bytes per cell beside the descriptors: DAISY's eight orientations five times (as they are, per
/// ring, and half smoothed) with what is known of each ring, and the channels with their weights.
constexpr double kLayerBytes = 5 * 4.0 * kDaisyOrientations + 3 * 4.0 + 3 * 8.0;
constexpr double kGibi = 1024.0 * 1024.0 * 1024.0;

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

void requireMemory(const Part& part, const GridFrame& frame, const DescribeOptions& options) {
  const double bytes = describingBytes(static_cast<double>(part.rows) * part.cols);
  if (bytes <= options.max_memory * kGibi) return;
  throw UsageError(fmt::format(
      "descriptors of a map of {:.0f} x {:.0f} m in cells of {:.3g} m need {:.1f} GiB of memory, "
      "more than the {:.3g} GiB of flow.describe.max_memory; tighten the prior, enlarge the cells "
      "or raise the limit",
      part.cols * frame.cell, part.rows * frame.cell, frame.cell, bytes / kGibi,
      options.max_memory));
}

/// A channel of the map; cells without points have `empty_weight` and the value 0.
template <typename Value>
MaskedRaster extract(const map::GridMap& map, const Part& part, float empty_weight,
                     const Value& value) {
  MaskedRaster out{Raster<float>(part.rows, part.cols),
                   Raster<float>(part.rows, part.cols, empty_weight)};
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
  std::vector<MaskedRaster> filled;  ///< where there are points, if empty cells count as zero
};

Channels channelsOf(const map::GridMap& map, const Part& part, const DescribeOptions& options) {
  const map::DataTerm term = options.term;
  const bool zero = options.empty == EmptyCells::kZero;
  const auto channel = [&](const auto& value) {
    return extract(map, part, zero ? 1.0F : 0.0F, value);
  };
  Channels channels;
  if (term == map::DataTerm::kRgb) {
    channels.visual = {channel([&](std::size_t i) { return static_cast<float>(map.colour[i].r); }),
                       channel([&](std::size_t i) { return static_cast<float>(map.colour[i].g); }),
                       channel([&](std::size_t i) { return static_cast<float>(map.colour[i].b); })};
  } else if (term != map::DataTerm::kHeight) {
    channels.visual = {channel([&](std::size_t i) { return map.exg[i]; })};
  }
  if (term == map::DataTerm::kExgHeight || term == map::DataTerm::kHeight) {
    channels.height = {channel([&](std::size_t i) { return map.height[i]; })};
  }
  if (zero) {
    channels.filled = {extract(map, part, 0.0F, [](std::size_t) { return 1.0F; })};
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
  // Where there is no point there is nothing to match, whatever lies around it.
  if (!channels.filled.empty()) {
    const Raster<float>& weight = channels.filled.front().weight;
    for (std::size_t i = 0; i < cells; ++i) {
      if (!(weight[i] > 0.0F)) out.known[i] = 0;
    }
  }
  return out;
}

}  // namespace

double describingBytes(double cells) {
  return cells * (DescriptorMap::kStride + sizeof(std::uint32_t) + kLayerBytes);
}

std::vector<DescriptorMap> describeMap(const map::GridMap& map, const map::Box2& window, int levels,
                                       const DescribeOptions& options) {
  const Part part = partIn(map.frame, window);
  if (part.rows == 0 || part.cols == 0) return {};
  requireMemory(part, map.frame, options);
  GridFrame frame = map.frame;
  frame.corner += frame.cell * Eigen::Vector2d(part.col, part.row);
  frame.rows = part.rows;
  frame.cols = part.cols;
  Channels channels = channelsOf(map, part, options);
  std::vector<DescriptorMap> result;
  for (int level = 0; level < levels; ++level) {
    if (level > 0) {
      for (auto* kind : {&channels.visual, &channels.height, &channels.filled}) {
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
