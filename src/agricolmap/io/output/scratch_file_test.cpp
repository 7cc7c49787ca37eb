#include "agricolmap/io/output/scratch_file.hpp"

#include <array>

#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

TEST(ScratchFile, KeepsBytesAndHasNoName) {
  const TempDir dir;
  ScratchFile file(dir.path(), "the points");
  file.reserve(100);
  const std::array<std::byte, 3> written{std::byte{1}, std::byte{2}, std::byte{3}};
  file.write(97, written);
  std::array<std::byte, 3> read{};
  file.read(97, read);
  EXPECT_EQ(read, written);
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

TEST(ScratchFile, SaysWhatFailedAndWhatHelps) {
  const TempDir dir;
  expectError<OutputError>([&] { ScratchFile(dir / "none", "the points", "take another folder"); },
                           {"the points: No such file or directory; take another folder"});
  ScratchFile file(dir.path(), "the points");
  std::array<std::byte, 3> read{};
  expectError<OutputError>([&] { file.read(0, read); }, {"the points: Input/output error"});
}

}  // namespace
}  // namespace agricolmap::io
