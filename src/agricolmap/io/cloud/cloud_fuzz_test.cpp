// Damaged files must give an InputError or a cloud, never anything else.
#include <lzf.h>

#include <cmath>
#include <vector>

#include "agricolmap/io/fuzz_test_support.hpp"

namespace agricolmap::io {
namespace {

using test::append;

std::vector<std::string> validFiles() {
  std::vector<std::string> files;
  const std::string vertex =
      "element vertex 20\nproperty float x\nproperty double y\nproperty float z\nproperty uchar "
      "red\nproperty uchar green\nproperty uchar blue\n";
  const std::string face = "element face 2\nproperty list uchar int vertex_indices\n";
  std::string plain;
  std::string listed;
  std::string text;
  std::string columns;
  for (int i = 0; i < 20; ++i) {
    std::string point;
    append(point, 0.5F * static_cast<float>(i));
    append(point, 1.25 * i);
    append(point, 3.0F);
    point += "rgb";
    plain += point;
    listed += std::string("\x02pq", 3) + point;
    text += std::to_string(i) + " 1.5 2 10 20 30\n";
  }
  for (int i = 0; i < 60; ++i) append(columns, static_cast<float>(i % 20));
  std::string faces;
  for (int i = 0; i < 2; ++i) faces += std::string("\x03", 1) + std::string(12, '\1');
  const std::string le = "ply\nformat binary_little_endian 1.0\n";
  files.push_back(le + vertex + face + "end_header\n" + plain + faces);
  files.push_back(le + face + vertex + "end_header\n" + faces + plain);
  files.push_back("ply\nformat binary_big_endian 1.0\n" + vertex + "end_header\n" + plain);
  files.push_back("ply\nformat ascii 1.0\n" + vertex + "end_header\n" + text);
  std::string with_list = vertex;
  with_list.insert(with_list.find("property"), "property list uchar char l\n");
  files.push_back(le + with_list + "end_header\n" + listed);
  const std::string pcd =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 1\nPOINTS "
      "20\nDATA ";
  files.push_back(pcd + "binary\n" + columns);
  std::vector<char> buffer(1024);
  const unsigned size =
      lzf_compress(columns.data(), static_cast<unsigned>(columns.size()), buffer.data(), 1024);
  std::string compressed;
  append(compressed, static_cast<std::uint32_t>(size));
  append(compressed, static_cast<std::uint32_t>(columns.size()));
  files.push_back(pcd + "binary_compressed\n" + compressed + std::string(buffer.data(), size));
  return files;
}

TEST(CloudFuzz, DamagedFilesAreReadOrRefused) {
  const test::Survived survived = test::readDamaged(validFiles(), 260, 1500, 11);
  EXPECT_GT(survived.read, 500);
  EXPECT_GT(survived.refused, 2000);
}

}  // namespace
}  // namespace agricolmap::io
