#include "agricolmap/io/cloud/cloud_stream.hpp"

#include <cstdlib>
#include <limits>
#include <optional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

/// Lets nothing be kept, however small.
const StreamOptions kStreamed{.read = {}, .keep = 0, .on_pass = {}, .crs = {}};

Cloud randomCloud(std::size_t points) {
  Random random(5);
  Cloud cloud;
  cloud.origin = {500000, 5400000, 300};
  for (std::size_t i = 0; i < points; ++i) {
    cloud.xyz.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-1, 1));
    cloud.rgb.push_back({static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256))});
  }
  return cloud;
}

/// All points of a pass, as a cloud; whether its batches are whole is looked at on the way.
Cloud gathered(const PointStream& stream) {
  Cloud cloud;
  stream.pass([&](const PointBatch& batch) {
    EXPECT_EQ(batch.first, cloud.size());
    EXPECT_EQ(cloud.size() % PointStream::kBatch, 0U);
    EXPECT_EQ(batch.rgb.size(), stream.facts().coloured ? batch.size() : 0U);
    cloud.xyz.insert(cloud.xyz.end(), batch.xyz.begin(), batch.xyz.end());
    cloud.rgb.insert(cloud.rgb.end(), batch.rgb.begin(), batch.rgb.end());
  });
  return cloud;
}

/// A stream of the file gives what reading it does, to the bit and on each pass.
void expectSameAsRead(const std::filesystem::path& path, const CoordinateMap* map = nullptr) {
  SCOPED_TRACE(path.string());
  StreamOptions options = kStreamed;
  options.read.map = map;
  const Cloud cloud = readCloud(path, options.read);
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    const auto stream = streamCloud(path, options);
    const CloudFacts& facts = stream->facts();
    EXPECT_EQ(facts.name, cloud.name);
    EXPECT_EQ(facts.origin, cloud.origin);
    EXPECT_EQ(facts.points, cloud.size());
    EXPECT_EQ(facts.coloured, cloud.hasColour());
    EXPECT_EQ(facts.dropped_points, cloud.dropped_points);
    EXPECT_EQ(facts.warnings, cloud.warnings);
    EXPECT_EQ(facts.fields, cloud.fields);
    const CloudFacts alone = factsOfFile(path, options);
    EXPECT_EQ(alone.origin, cloud.origin);
    EXPECT_EQ(alone.points, cloud.size());
    EXPECT_EQ(alone.warnings, cloud.warnings);
    EXPECT_EQ(stream->box().min, boundingBox(cloud).min);
    EXPECT_EQ(stream->box().max, boundingBox(cloud).max);
    for (int pass = 0; pass < 2; ++pass) {
      const Cloud same = gathered(*stream);
      EXPECT_TRUE(same.xyz == cloud.xyz);
      EXPECT_TRUE(same.rgb == cloud.rgb);
    }
  }
}

std::vector<CloudFormat> formats() {
  std::vector<CloudFormat> all{CloudFormat::kPly, CloudFormat::kPcd, CloudFormat::kLas};
#ifdef AGRICOLMAP_HAS_LASZIP
  all.push_back(CloudFormat::kLaz);
#endif
  return all;
}

TEST(CloudStream, GivesWhatReadingGivesInEveryFormat) {
  const TempDir dir;
  const Cloud cloud = randomCloud(PointStream::kBatch + 130'000);
  for (const CloudFormat format : formats()) {
    const auto path = dir / ("cloud." + endingOf(format));
    writeCloud(path, cloud, format);
    expectSameAsRead(path);
  }
}

/// What is left out leaves no gaps, and batches are whole all the same.
TEST(CloudStream, ClosesTheGapsOfWhatIsLeftOut) {
  const TempDir dir;
  Cloud cloud = randomCloud(PointStream::kBatch + 30'000);
  for (std::size_t i = 3; i < cloud.size(); i += 7) {
    cloud.xyz[i].y() = i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : 3e4F;
  }
  writePly(dir / "gaps.ply", cloud);
  expectSameAsRead(dir / "gaps.ply");
  test::LasBytes las;
  for (int i = 0; i < 40'000; ++i) {
    las.add(i, 2 * i, i % 100, {static_cast<std::uint16_t>(i), 7, 9}, i % 5 == 0);
  }
  expectSameAsRead(dir.write("withheld.las", las.bytes()));
}

TEST(CloudStream, KnowsTextListsAndColoursThatComeLate) {
  const TempDir dir;
  std::string ascii =
      "ply\nformat ascii 1.0\nelement vertex 30000\nproperty double x\nproperty double y\n"
      "property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "end_header\n";
  std::string listed =
      "ply\nformat binary_little_endian 1.0\nelement vertex 30000\nproperty float x\n"
      "property list uchar uchar more\nproperty float y\nproperty float z\nend_header\n";
  std::string pcd =
      "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 30000\n"
      "HEIGHT 1\nPOINTS 30000\nDATA ascii\n";
  test::LasBytes las;
  for (int i = 0; i < 30'000; ++i) {
    const std::string place = std::to_string(i / 100) + " " + std::to_string(i % 100) + " 1";
    ascii += place + " " + std::to_string(i % 256) + " 2 3\n";
    pcd += place + " " + std::to_string(i) + "\n";
    test::append(listed, static_cast<float>(i));
    listed += i % 3 == 0 ? std::string("\2ab", 3) : std::string("\0", 1);
    test::append(listed, 1.0F);
    test::append(listed, 2.0F);
    // A first look takes them for colours of 8 bit.
    las.add(i, 2 * i, 5, {static_cast<std::uint16_t>(i == 29'990 ? 60'000 : 90), 80, 70});
  }
  expectSameAsRead(dir.write("ascii.ply", ascii));
  expectSameAsRead(dir.write("listed.ply", listed));
  expectSameAsRead(dir.write("ascii.pcd", pcd));
  expectSameAsRead(dir.write("late.las", las.bytes()));
  for (std::string& point : las.points) point.replace(20, 6, std::string(6, '\0'));
  expectSameAsRead(dir.write("black.las", las.bytes()));
}

/// What a first look at few points cannot know: a file is taken twice.
TEST(CloudStream, TakesAgainWhatTheFirstLookMisjudged) {
  const TempDir dir;
  test::LasBytes las;
  std::string holes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 40000\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n";
  std::string text;
  for (int i = 0; i < 40'000; ++i) {
    const bool late = i > 39'900;
    las.add(i, 2 * i, 5, {static_cast<std::uint16_t>(late ? 60'000 : 90), 80, 70});
    const bool hole = i % 1000 == 997;
    for (const double value : {i / 100.0, i % 100 / 1.0, hole ? -9999.0 : 1.0}) {
      test::append(holes, value);
    }
    text += std::to_string(i / 100) + " " + std::to_string(i % 100) + (hole ? " -9999" : " 1") +
            (i == 20'005 ? " 300" : " 3") + " 4 5\n";
  }
  const auto late_las = dir.write("late.las", las.bytes());
  expectSameAsRead(late_las);
  EXPECT_EQ(readCloud(late_las).rgb.back(), (Rgb{233, 0, 0}));
  const auto holes_ply = dir.write("holes.ply", holes);
  expectSameAsRead(holes_ply);
  EXPECT_EQ(readCloud(holes_ply).dropped_points, 40U);
  const auto lines = dir.write("lines.txt", text);
  expectSameAsRead(lines);
  EXPECT_EQ(readCloud(lines).dropped_points, 41U);
}

class Feet : public CoordinateMap {
 public:
  void apply(double* x, double* y, double* z, std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) {
      x[i] *= 0.3048;
      y[i] *= 0.3048;
      z[i] *= 0.3048;
    }
  }
};

TEST(CloudStream, BringsCoordinatesIntoOthers) {
  const TempDir dir;
  writeCloud(dir / "feet.las", randomCloud(100'000), CloudFormat::kLas);
  const Feet feet;
  expectSameAsRead(dir / "feet.las", &feet);
}

TEST(CloudStream, TellsHowFarAPassIs) {
  const TempDir dir;
  const Cloud cloud = randomCloud(PointStream::kBatch + 10);
  writeCloud(dir / "cloud.las", cloud, CloudFormat::kLas);
  std::vector<std::size_t> seen;
  StreamOptions options = kStreamed;
  options.on_pass = [&](std::size_t points, std::size_t of) {
    EXPECT_EQ(of, cloud.size());
    seen.push_back(points);
  };
  const auto stream = streamCloud(dir / "cloud.las", options);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), cloud.size());
  seen.clear();
  gathered(*stream);
  EXPECT_EQ(seen, (std::vector<std::size_t>{PointStream::kBatch, cloud.size()}));
}

TEST(CloudStream, AFileThatChangesMeanwhileIsAnError) {
  const TempDir dir;
  const auto path = dir / "cloud.las";
  writeCloud(path, randomCloud(50'000), CloudFormat::kLas);
  const auto stream = streamCloud(path, kStreamed);
  gathered(*stream);
  std::filesystem::resize_file(path, 10'000);
  expectError<InputError>([&] { gathered(*stream); }, {"cloud.las", "changed while it was read"});
}

#ifdef AGRICOLMAP_HAS_LASZIP
TEST(CloudStream, ADamagedChunkIsAnErrorAtOnce) {
  const TempDir dir;
  const auto path = dir / "cloud.laz";
  writeCloud(path, randomCloud(200'000), CloudFormat::kLaz);
  std::string bytes = test::contentOf(path);
  bytes.replace(bytes.size() * 3 / 5, 4000, std::string(4000, '\x55'));
  dir.write("cloud.laz", bytes);
  expectError<InputError>([&] { streamCloud(path, kStreamed); }, {"cloud.laz", "damaged"});
}

/// The environment, put back when the test ends.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& folder) {
    if (const char* const before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFolder() { before_ ? ::setenv("TMPDIR", before_->c_str(), 1) : ::unsetenv("TMPDIR"); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::optional<std::string> before_;
};

TEST(CloudStream, DecodedPointsAreKeptInAFileWithoutAName) {
  const TempDir dir;
  const TempDir room;
  writeCloud(dir / "cloud.laz", randomCloud(100'000), CloudFormat::kLaz);
  {
    const TemporaryFolder folder(room.path().string());
    const auto stream = streamCloud(dir / "cloud.laz", kStreamed);
    EXPECT_TRUE(std::filesystem::is_empty(room.path()));
    EXPECT_EQ(gathered(*stream).size(), 100'000U);
  }
  const TemporaryFolder none((room / "none").string());
  EXPECT_EQ(factsOfFile(dir / "cloud.laz").points, 100'000U);  // which needs no room
  expectError<OutputError>([&] { streamCloud(dir / "cloud.laz", kStreamed); },
                           {"cloud.laz", "none", "TMPDIR", "No such file"});
}
#endif

}  // namespace
}  // namespace agricolmap::io
