#include "agricolmap/io/las/copc_writer.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "agricolmap/io/las/copc_nodes.hpp"
#include "agricolmap/io/las/copc_octree.hpp"
#include "agricolmap/io/output/scratch_file.hpp"
#include "agricolmap/io/output/write_behind.hpp"

namespace agricolmap::io {
namespace {

/// Of the records of a part, which a thread keeps in memory, and three times as much to sort them.
constexpr std::size_t kPartBytes = std::size_t{32} << 20;
constexpr std::size_t kChunksTogether = 8;
constexpr std::size_t kPartsTogether = 2;
constexpr std::uint16_t kInfo = 1;
constexpr std::uint16_t kHierarchy = 1000;
constexpr std::size_t kInfoBytes = 160;
constexpr std::size_t kEntryBytes = 32;
constexpr std::size_t kExtendedRecordHeader = 60;

struct Entry {
  CopcKey key;
  std::uint64_t offset = 0;
  std::size_t bytes = 0;
  std::uint64_t points = 0;
};

std::vector<std::byte> infoOf(const CopcCube& cube, const CopcExtent& extent,
                              std::uint64_t hierarchy, std::size_t hierarchy_bytes) {
  std::vector<std::byte> info(kInfoBytes);
  const double half = 0.5 * cube.size;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    storeLe(&info[8 * axis], cube.corner[static_cast<Eigen::Index>(axis)] + half);
  }
  storeLe(&info[24], half);
  storeLe(&info[32], cube.size / (1 << kCopcGridBits));
  storeLe(&info[40], hierarchy);
  storeLe(&info[48], static_cast<std::uint64_t>(hierarchy_bytes));
  storeLe(&info[56], extent.first_time);
  storeLe(&info[64], extent.last_time);
  return info;
}

std::vector<std::byte> hierarchyOf(std::vector<Entry> entries) {
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.key < b.key; });
  std::vector<std::byte> bytes(entries.size() * kEntryBytes);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::byte* const to = &bytes[i * kEntryBytes];
    const Entry& entry = entries[i];
    storeLe(to, entry.key.level);
    storeLe(to + 4, entry.key.x);
    storeLe(to + 8, entry.key.y);
    storeLe(to + 12, entry.key.z);
    storeLe(to + 16, entry.offset);
    storeLe(to + 24, static_cast<std::int32_t>(entry.bytes));
    storeLe(to + 28, static_cast<std::int32_t>(entry.points));
  }
  return bytes;
}

/// Records of a chunk, those of each part together and in their order.
struct SortedRecords {
  std::vector<std::byte> records;
  std::vector<std::pair<std::size_t, std::size_t>> counts;  ///< of the parts that it has
};

void sortByPart(const std::vector<std::byte>& records, const LasOutline& outline,
                const CopcCube& cube, const CopcParts& parts, SortedRecords& sorted) {
  const std::size_t length = outline.layout.length;
  std::vector<std::pair<std::size_t, std::size_t>> order;  // part, index
  for (std::size_t i = 0; i * length < records.size(); ++i) {
    order.emplace_back(parts.partOf(cube.place(outline, &records[i * length])), i);
  }
  std::sort(order.begin(), order.end());
  sorted.counts.clear();
  sorted.records.resize(records.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto [part, from] = order[i];
    if (sorted.counts.empty() || sorted.counts.back().first != part) {
      sorted.counts.emplace_back(part, 0);
    }
    ++sorted.counts.back().second;
    std::copy_n(&records[from * length], length, &sorted.records[i * length]);
  }
}

/// Lays all records into the scratch file, those of a part together and in their order.
void sortIntoParts(const LasFeed& feed, const CopcCube& cube, const CopcParts& parts,
                   ScratchFile& scratch) {
  const std::size_t length = feed.outline().layout.length;
  std::vector<std::uint64_t> written(parts.parts().size(), 0);
  feed.pass([&](std::size_t chunks, const LasFeed::Load& load) {
    writeBehind<SortedRecords>(
        chunks, kChunksTogether,
        [&](std::size_t chunk, SortedRecords& sorted) {
          std::vector<std::byte> records;
          load(chunk, records);
          sortByPart(records, feed.outline(), cube, parts, sorted);
        },
        [&](const SortedRecords& sorted) {
          std::size_t done = 0;
          for (const auto& [part, count] : sorted.counts) {
            const std::uint64_t at = parts.parts()[part].first + written[part];
            scratch.write(at * length, std::span(sorted.records).subspan(done, count * length));
            written[part] += count;
            done += count * length;
          }
          feed.forget();
        });
  });
}

/// Compresses nodes and keeps the list of them.
class Nodes {
 public:
  Nodes(LasWriter& writer, const LasLayout& layout) : writer_(writer), layout_(layout) {}

  struct Compressed {
    CopcKey key;
    std::vector<std::byte> chunk;
    LasTally tally;
  };
  Compressed compressed(const CopcNode& node) const {
    const std::size_t count = node.records.size() / layout_.length;
    Compressed result{node.key, lazChunk(node.records.data(), count, layout_), {}};
    result.tally.add(node.records.data(), count, layout_);
    return result;
  }
  void write(const Compressed& node) {
    const std::uint64_t offset = writer_.writeChunk(node.chunk, node.tally);
    entries_.push_back({node.key, offset, node.chunk.size(), node.tally.points});
  }
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  LasWriter& writer_;
  const LasLayout& layout_;
  std::vector<Entry> entries_;
};

/// Reads part after part again, and writes the nodes below it, and those above it that no later one
/// has points for.
void writeNodes(const LasOutline& outline, const CopcCube& cube, const CopcParts& parts,
                const ScratchFile& scratch, Nodes& nodes, const std::function<void()>& written) {
  struct Part {
    std::size_t index = 0;
    std::vector<CopcNode> above;
    std::vector<Nodes::Compressed> below;
  };
  std::map<CopcKey, CopcNode> open;  ///< above the parts so far
  const std::size_t length = outline.layout.length;
  writeBehind<Part>(
      parts.parts().size(), kPartsTogether,
      [&](std::size_t i, Part& part) {
        const CopcParts::Part& from = parts.parts()[i];
        part = {i, {}, {}};
        std::vector<std::byte> records(from.points * length);
        scratch.read(from.first * length, records);
        for (CopcNode& node : copcNodes(records, outline, cube, from.key)) {
          if (node.key.level < from.key.level) {
            part.above.push_back(std::move(node));
          } else {
            part.below.push_back(nodes.compressed(node));
          }
        }
      },
      [&](const Part& part) {
        for (const CopcNode& node : part.above) {
          CopcNode& whole = open[node.key];
          whole.key = node.key;
          whole.records.insert(whole.records.end(), node.records.begin(), node.records.end());
        }
        for (const Nodes::Compressed& node : part.below) nodes.write(node);
        const bool last = part.index + 1 == parts.parts().size();
        for (auto it = open.begin(); it != open.end();) {
          const bool more = !last && it->first.holds(parts.parts()[part.index + 1].key);
          if (!more) nodes.write(nodes.compressed(it->second));
          it = more ? std::next(it) : open.erase(it);
        }
        written();
      });
}

}  // namespace

std::uint64_t writeCopc(const LasFeed& feed, const OutputPath& to, const CopyProgress& progress) {
  const CopcExtent extent = extentOf(feed);
  const CopcCube cube = cubeOf(feed, extent);
  LasOutline outline = feed.outline();
  // The information comes first of all records, the list of nodes first of those behind the points.
  outline.records.insert(outline.records.begin(),
                         {{"copc", kInfo, "COPC info", std::vector<std::byte>(kInfoBytes), false},
                          {"copc", kHierarchy, "EPT hierarchy", {}, true}});
  LasWriter writer(to, std::move(outline), LasWriter::Points::kChunks);
  Nodes nodes(writer, feed.outline().layout);
  {
    ScratchFile scratch(to.file().parent_path(),
                        to.shown() + ": its records need room beside it for a while");
    const CopcParts parts(feed, cube, kPartBytes / feed.outline().layout.length);
    sortIntoParts(feed, cube, parts, scratch);
    writeNodes(feed.outline(), cube, parts, scratch, nodes, [&] {
      if (progress) progress(writer.points(), feed.points());
    });
  }
  std::vector<Entry> entries = nodes.entries();
  if (entries.empty()) entries.emplace_back();
  auto& records = writer.outline().records;
  records[1].data = hierarchyOf(std::move(entries));
  records[0].data =
      infoOf(cube, extent, writer.endPoints() + kExtendedRecordHeader, records[1].data.size());
  writer.close();
  return writer.points();
}

}  // namespace agricolmap::io
