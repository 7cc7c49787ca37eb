// The nodes of one part of a COPC file, thinned from the top down.
#pragma once

#include <vector>

#include "agricolmap/io/las/copc_octree.hpp"

namespace agricolmap::io {

/// Points along the edge of a node, at most: what a level shows is as fine as its nodes' 128th.
inline constexpr int kCopcGridBits = 7;

/// A node's points, as records.
struct CopcNode {
  CopcKey key;
  std::vector<std::byte> records;
};

/// Every node keeps, of each cell of its grid, the point nearest to the cell's middle, and hands
/// the others down; one that has few keeps all. Nodes above `part` get what this part has for them;
/// they come first, then those from `part` down, depth first. Points keep their order.
std::vector<CopcNode> copcNodes(const std::vector<std::byte>& records, const LasOutline& outline,
                                const CopcCube& cube, const CopcKey& part);

}  // namespace agricolmap::io
