#include "agricolmap/io/las/copc_writer.hpp"

#include <gmock/gmock.h>
#ifdef AGRICOLMAP_HAS_LASZIP
#include <laszip/laszip_api.h>
#endif

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/las/copc_nodes.hpp"
#include "agricolmap/io/las/copc_octree.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/las/las_lift.hpp"
#include "agricolmap/io/las/las_test_support.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;
using test::TempDir;

/// A field of points in 20 m × 10 m whose attributes all differ.
LasBytes fieldOf(int format, std::int32_t points) {
  Random random(11);
  LasBytes file;
  file.format = format;
  file.minor = format < 6 ? 2 : 4;
  file.extra_bytes = 3;
  const LasLayout layout = file.layout();
  for (std::int32_t i = 0; i < points; ++i) {
    file.add(static_cast<std::int32_t>(random.below(20000)),
             static_cast<std::int32_t>(random.below(10000)),
             static_cast<std::int32_t>(random.below(300)), {1, 2, 3});
    std::string& point = file.points.back();
    LasBytes::set(point, 12, static_cast<std::uint16_t>(i));
    LasBytes::set(point, layout.base, static_cast<std::uint16_t>(i >> 16));
    if (layout.gps_time) LasBytes::set(point, *layout.gps_time, 1000.0 + i);
    point[14] = static_cast<char>(0x11);
  }
  return file;
}

class CopcFile : public ::testing::Test {
 protected:
  void SetUp() override {
#ifndef AGRICOLMAP_HAS_LASZIP
    GTEST_SKIP() << "built without LASzip";
#endif
  }
  CopiedCloud write(const LasBytes& file, const Crs& crs = {}) {
    return copyLas(folder_.write("in.las", file.bytes()), folder_ / "out.copc.laz",
                   CloudFormat::kCopc, std::nullopt, crs);
  }
  TempDir folder_;
};

struct Node {
  std::uint64_t offset = 0;
  std::int32_t bytes = 0;
  std::int32_t points = 0;
};

std::map<CopcKey, Node> nodesOf(const LasRecord& hierarchy) {
  std::map<CopcKey, Node> nodes;
  for (std::size_t at = 0; at < hierarchy.data.size(); at += 32) {
    const std::byte* const entry = &hierarchy.data[at];
    const auto number = [&](std::size_t i) { return loadLe<std::int32_t>(entry + 4 * i); };
    nodes[{number(0), number(1), number(2), number(3)}] = {loadLe<std::uint64_t>(entry + 16),
                                                           number(6), number(7)};
  }
  return nodes;
}

TEST_F(CopcFile, IsWhatTheSpecificationAsksFor) {
  const LasBytes file = fieldOf(3, 120000);
  EXPECT_EQ(write(file, {"somewhere", "PROJCS[\"somewhere\"]"}).points, 120000U);
  const MappedFile written(folder_ / "out.copc.laz");
  const auto bytes = written.bytes();
  const LasHeader header = parseLasHeader(bytes, "out");
  EXPECT_EQ(header.minor, 4);
  EXPECT_EQ(header.layout.format, 7);
  EXPECT_EQ(header.layout.extraBytes(), 3U);
  EXPECT_NE(header.flags & 0x10, 0);
  EXPECT_NE(header.find("LASF_Projection", 2112), nullptr);

  // The information is the first record, right behind the header.
  ASSERT_EQ(header.records[0].user, "copc");
  const std::byte* const info = header.records[0].data.data();
  EXPECT_EQ(info - bytes.data(), 375 + 54);
  ASSERT_EQ(header.records[0].data.size(), 160U);
  const double half = loadLe<double>(info + 24);
  EXPECT_DOUBLE_EQ(loadLe<double>(info + 32), 2.0 * half / 128.0);
  EXPECT_EQ(loadLe<double>(info + 56), 1000.0);
  EXPECT_EQ(loadLe<double>(info + 64), 1000.0 + 119999.0);
  Eigen::Vector3d corner;
  for (Eigen::Index i = 0; i < 3; ++i) corner[i] = loadLe<double>(info + 8 * i) - half;

  const LasRecord* const hierarchy = header.find("copc", 1000);
  ASSERT_NE(hierarchy, nullptr);
  EXPECT_TRUE(hierarchy->extended);
  EXPECT_EQ(loadLe<std::uint64_t>(info + 40), hierarchy->data.data() - bytes.data());
  EXPECT_EQ(loadLe<std::uint64_t>(info + 48), hierarchy->data.size());
  std::map<CopcKey, Node> nodes = nodesOf(*hierarchy);
  EXPECT_TRUE(nodes.contains({0, 0, 0, 0}));
  EXPECT_GT(nodes.size(), 8U);

  // Every node is a chunk, its parent is there, and its points lie in it.
  const auto points = lasPoints(bytes, header, "out");
  ASSERT_EQ(points->chunks(), nodes.size());
  std::map<std::uint64_t, CopcKey> by_offset;
  for (const auto& [key, node] : nodes) {
    by_offset[node.offset] = key;
    EXPECT_TRUE(key.level == 0 || nodes.contains(key.parent(1)));
  }
  std::size_t chunk = 0;
  std::uint64_t sum = 0;
  for (const auto& [offset, key] : by_offset) {
    const double cell = 2.0 * half / std::pow(2.0, key.level);
    const Eigen::Vector3d low = corner + cell * Eigen::Vector3d(key.x, key.y, key.z);
    std::int32_t count = 0;
    points->decode(chunk++, LasWanted::kAll, [&](const std::byte* record, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i, record += header.layout.length, ++count) {
        const Eigen::Vector3d in = (header.pointOf(record) - low) / cell;
        ASSERT_GT(in.minCoeff(), -1e-6);
        ASSERT_LT(in.maxCoeff(), 1.0 + 1e-6);
      }
    });
    EXPECT_EQ(count, nodes[key].points);
    sum += static_cast<std::uint64_t>(count);
  }
  EXPECT_EQ(sum, 120000U);
}

TEST_F(CopcFile, KeepsEveryBitOfEveryPoint) {
  for (const int format : {6, 7, 8}) {
    const LasBytes file = fieldOf(format, 60000);
    write(file);
    const MappedFile written(folder_ / "out.copc.laz");
    const LasHeader header = parseLasHeader(written.bytes(), "out");
    EXPECT_EQ(header.layout.format, format);
    std::vector<std::string> all;
    const auto points = lasPoints(written.bytes(), header, "out");
    for (std::size_t chunk = 0; chunk < points->chunks(); ++chunk) {
      points->decode(chunk, LasWanted::kAll, [&](const std::byte* record, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i, record += header.layout.length) {
          all.emplace_back(reinterpret_cast<const char*>(record), header.layout.length);
        }
      });
    }
    std::vector<std::string> expected = file.points;
    std::sort(expected.begin(), expected.end());
    std::sort(all.begin(), all.end());
    EXPECT_TRUE(all == expected) << format;
  }
}

#ifdef AGRICOLMAP_HAS_LASZIP
/// X, Y and Z of all points of a file, by LASzip alone, and again of those that it jumps to.
std::vector<std::array<std::int32_t, 3>> byLaszip(const std::filesystem::path& path,
                                                  std::size_t points, std::size_t jump) {
  std::vector<std::array<std::int32_t, 3>> all;
  laszip_POINTER reader = nullptr;
  laszip_BOOL compressed = 0;
  laszip_point* point = nullptr;
  EXPECT_EQ(laszip_create(&reader), 0);
  EXPECT_EQ(laszip_open_reader(reader, path.c_str(), &compressed), 0);
  EXPECT_EQ(laszip_get_point_pointer(reader, &point), 0);
  for (std::size_t i = 0; i < points && laszip_read_point(reader) == 0; ++i) {
    all.push_back({point->X, point->Y, point->Z});
  }
  for (std::size_t i = points; i-- > 0;) {
    if (i % jump != 0) continue;
    EXPECT_EQ(laszip_seek_point(reader, static_cast<laszip_I64>(i)), 0);
    EXPECT_EQ(laszip_read_point(reader), 0);
    EXPECT_EQ(point->X, all.at(i)[0]);
  }
  laszip_close_reader(reader);
  laszip_destroy(reader);
  return all;
}

TEST_F(CopcFile, LaszipReadsBothByTheirTablesOfChunks) {
  const LasBytes file = fieldOf(7, 120000);
  write(file);
  copyLas(folder_ / "in.las", folder_ / "out.laz", CloudFormat::kLaz);
  auto copc = byLaszip(folder_ / "out.copc.laz", 120000, 7001);
  auto laz = byLaszip(folder_ / "out.laz", 120000, 7001);
  ASSERT_EQ(copc.size(), 120000U);
  ASSERT_EQ(laz.size(), 120000U);
  for (std::size_t i = 0; i < laz.size(); ++i) {
    std::array<std::int32_t, 3> xyz{};
    std::memcpy(xyz.data(), file.points[i].data(), sizeof(xyz));
    ASSERT_EQ(laz[i], xyz);
  }
  std::sort(copc.begin(), copc.end());
  std::sort(laz.begin(), laz.end());
  EXPECT_TRUE(copc == laz);
}
#endif

TEST_F(CopcFile, ThreadsDoNotMatter) {
  const LasBytes file = fieldOf(7, 60000);
  write(file);
  const std::string many = test::contentOf(folder_ / "out.copc.laz");
  const ThreadLimit one(1);
  write(file);
  EXPECT_TRUE(test::contentOf(folder_ / "out.copc.laz") == many);
}

TEST_F(CopcFile, OldPointsAreLifted) {
  LasBytes file;
  file.format = 5;  // time, colours and wave packets
  file.minor = 3;
  file.extra_bytes = 1;
  file.add(1, 2, 3, {100, 200, 300});
  std::string& point = file.points.back();
  LasBytes::set(point, 12, std::uint16_t{4321});
  point[14] = static_cast<char>(2 | 5 << 3 | 1 << 6);  // return 2 of 5, scanning forwards
  point[15] = static_cast<char>(12 | 0x20);            // overlap, synthetic
  point[16] = static_cast<char>(-15);
  point[17] = 9;
  LasBytes::set(point, 18, std::uint16_t{77});
  LasBytes::set(point, 20, 123.5);
  point.back() = 'e';
  EXPECT_THAT(write(file).warnings, ::testing::ElementsAre(::testing::HasSubstr("wave packets")));
  const MappedFile written(folder_ / "out.copc.laz");
  const LasHeader header = parseLasHeader(written.bytes(), "out");
  ASSERT_EQ(header.layout.format, 7);
  lasPoints(written.bytes(), header, "out")
      ->decode(0, LasWanted::kAll, [&](const std::byte* record, std::size_t) {
        EXPECT_EQ(header.pointOf(record), Eigen::Vector3d(500000.001, 5400000.002, 100.003));
        EXPECT_EQ(loadLe<std::uint16_t>(record + 12), 4321);
        EXPECT_EQ(record[14], std::byte{0x52});
        EXPECT_EQ(record[15], std::byte{0x01 | 0x08 | 1 << 6});
        EXPECT_EQ(record[16], std::byte{1});
        EXPECT_EQ(record[17], std::byte{9});
        EXPECT_EQ(loadLe<std::int16_t>(record + 18), -2500);
        EXPECT_EQ(loadLe<std::uint16_t>(record + 20), 77);
        EXPECT_EQ(loadLe<double>(record + 22), 123.5);
        EXPECT_EQ(loadLe<std::uint16_t>(record + 30), 100);
        EXPECT_EQ(record[36], std::byte{'e'});
      });
}

TEST_F(CopcFile, CloudsOfOtherFormatsBecomeCopc) {
  Cloud cloud;
  cloud.origin = {500000.0, 5400000.0, 100.0};
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(0.0, 9.0)),
                           static_cast<float>(random.uniform(0.0, 9.0)), 0.0F);
    cloud.rgb.push_back({static_cast<std::uint8_t>(i), 1, 2});
  }
  writeCloud(folder_ / "out.copc.laz", cloud, CloudFormat::kCopc);
  const Cloud back = readCloud(folder_ / "out.copc.laz");
  ASSERT_EQ(back.size(), cloud.size());  // one node, so in the same order
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_LT((back.filePoint(i) - cloud.filePoint(i)).cwiseAbs().maxCoeff(), 0.000501);
    EXPECT_EQ(back.rgb[i], cloud.rgb[i]);
  }
}

/// All records of a feed, in their order.
std::vector<std::byte> recordsOf(const LasFeed& feed) {
  std::vector<std::byte> all;
  std::vector<std::byte> records;
  feed.pass([&](std::size_t chunks, const LasFeed::Load& load) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      load(chunk, records);
      all.insert(all.end(), records.begin(), records.end());
    }
  });
  return all;
}

TEST(CopcOctree, PartsAreSmallAndHoldAllPoints) {
  TempDir folder;
  LasBytes file = fieldOf(7, 50000);
  // Half of the points within a hand's breadth, and one far off: cells of the first count are
  // crowded.
  for (std::int32_t i = 0; i < 50000; ++i) file.add(i % 100, i / 500, 0);
  file.add(2000000000, 0, 0);
  const auto feed = feedOf(folder.write("in.las", file.bytes()), std::nullopt, {}, true);
  const CopcExtent extent = extentOf(*feed);
  EXPECT_EQ(extent.tally.points, 100001U);
  const CopcCube cube = cubeOf(*feed, extent);
  const CopcParts parts(*feed, cube, 30000);
  std::uint64_t sum = 0;
  for (const CopcParts::Part& part : parts.parts()) {
    EXPECT_EQ(part.first, sum);
    sum += part.points;
  }
  EXPECT_EQ(sum, 100001U);
  EXPECT_GT(parts.parts().size(), 3U);
  std::vector<std::uint64_t> found(parts.parts().size(), 0);
  const std::vector<std::byte> records = recordsOf(*feed);
  for (std::size_t at = 0; at < records.size(); at += feed->outline().layout.length) {
    const CopcPlace place = cube.place(feed->outline(), &records[at]);
    const std::size_t part = parts.partOf(place);
    ++found[part];
    EXPECT_TRUE(parts.parts()[part].key.holds(keyOf(place, 20)));
  }
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], parts.parts()[i].points);
}

TEST(CopcOctree, PartsMakeTheSameNodesAsTheWhole) {
  TempDir folder;
  const LasBytes file = fieldOf(7, 120000);
  const auto feed = feedOf(folder.write("in.las", file.bytes()), std::nullopt, {}, true);
  const CopcCube cube = cubeOf(*feed, extentOf(*feed));
  const std::vector<std::byte> all = recordsOf(*feed);
  std::map<CopcKey, std::size_t> whole;
  std::map<CopcKey, std::size_t> cut;
  for (const CopcNode& node : copcNodes(all, feed->outline(), cube, {})) {
    whole[node.key] = node.records.size();
  }
  const CopcParts parts(*feed, cube, 30000);
  std::vector<std::vector<std::byte>> of(parts.parts().size());
  const std::size_t length = feed->outline().layout.length;
  for (std::size_t at = 0; at < all.size(); at += length) {
    auto& part = of[parts.partOf(cube.place(feed->outline(), &all[at]))];
    part.insert(part.end(), &all[at], &all[at] + length);
  }
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (const CopcNode& node : copcNodes(of[i], feed->outline(), cube, parts.parts()[i].key)) {
      cut[node.key] += node.records.size();
    }
  }
  // Down to the parts; below, what is few may be kept earlier.
  for (const CopcKey& key : {CopcKey{0, 0, 0, 0}, CopcKey{1, 0, 0, 0}, CopcKey{1, 1, 0, 0}}) {
    EXPECT_EQ(whole[key], cut[key]);
  }
}

}  // namespace
}  // namespace agricolmap::io
