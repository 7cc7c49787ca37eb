// Damaged LAS and LAZ files must give an InputError or a cloud, never anything else.
#include <vector>

#include "agricolmap/io/fuzz_test_support.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;

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
    LasWriter writer(folder / "cloud.laz", outline, LasWriter::Points::kLaz);
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
  const test::Survived survived = test::readDamaged(validFiles(), 500, 3000, 17);
  EXPECT_GT(survived.read, 5000);
  EXPECT_GT(survived.refused, 5000);
}

#ifdef AGRICOLMAP_HAS_LASZIP
// LASzip 3.5 dereferences a null pointer where a file says that points of the extended formats were
// compressed one by one.
TEST(LasFuzz, ExtendedPointsThatClaimNoLayersAreRefused) {
  const std::string user = "laszip encoded";
  constexpr std::size_t kData = 52;  // of a record, behind the beginning of its user
  const test::TempDir folder;
  for (std::string file : validFiles()) {
    const std::size_t at = file.find(user);
    if (at == std::string::npos) continue;
    const bool layered = file[at + kData] == 3;
    file[at + kData] = layered ? 1 : 3;
    const std::filesystem::path path = folder.write("claims.laz", file);
    test::expectError<InputError>([&] { readCloud(path); },
                                  {"claims.laz", layered ? "compressor 1" : "compressor 3"});
  }
}
#endif

}  // namespace
}  // namespace agricolmap::io
