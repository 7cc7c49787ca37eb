// Damaged LAS and LAZ files must give an InputError or a cloud, never anything else.
#include <vector>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/fuzz_test_support.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

using test::damage;
using test::LasBytes;
using test::MemoryFile;

LasBytes points(int format, int minor) {
  LasBytes file;
  file.format = format;
  file.minor = minor;
  file.extra_bytes = format == 3 || format == 8 ? 3 : 0;
  for (std::int32_t i = 0; i < 20; ++i) {
    const auto value = static_cast<std::uint16_t>(i);
    file.add(10 * i, 3 * i * i, i % 4, {value, 255, 3});
  }
  file.records.push_back(LasBytes::record("LASF_Spec", 4, std::string(192, 'e')));
  return file;
}

std::vector<std::string> validFiles() {
  std::vector<std::string> files;
  for (const int format : {0, 2, 3, 5}) files.push_back(points(format, 2).bytes());
  for (const int format : {6, 7, 8}) files.push_back(points(format, 4).bytes());
#ifdef AGRICOLMAP_HAS_LASZIP
  const test::TempDir folder;
  for (const int format : {0, 3, 7, 8}) {
    const LasBytes plain = points(format, format < 6 ? 2 : 4);
    LasOutline outline = lasOutline(true);
    outline.layout = plain.layout();
    LasWriter writer(folder / "cloud.laz", outline, true);
    for (const std::string& point : plain.points) {
      writer.write(reinterpret_cast<const std::byte*>(point.data()), 1);
    }
    writer.close();
    files.push_back(test::contentOf(folder / "cloud.laz"));
  }
#endif
  return files;
}

TEST(LasFuzz, DamagedFilesAreReadOrRefused) {
  const MemoryFile memory;
  Random random(17);
  int read = 0;
  int refused = 0;
  for (const std::string& file : validFiles()) {
    ASSERT_EQ(readCloud(memory.write(file)).size(), 20U);
    for (int i = 0; i < 3000; ++i) {
      const auto path = memory.write(damage(file, 500, random));
      try {
        const Cloud cloud = readCloud(path);
        ++read;
        ASSERT_FALSE(cloud.empty());
        for (const Eigen::Vector3f& p : cloud.xyz) ASSERT_TRUE(p.allFinite());
      } catch (const InputError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(read, 5000);
  EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace agricolmap::io
