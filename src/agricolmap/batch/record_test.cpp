#include "agricolmap/batch/record.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>

#include "agricolmap/batch/summary.hpp"

namespace agricolmap::batch {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RecordTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("agricolmap_record_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    for (const char* file : {"drone.las", "a.ply", "prior.txt"}) write(file, "x");
    write("m.yaml",
          "maps: [{id: field, file: drone.las}]\n"
          "strips: [{id: a, file: a.ply, prior: prior.txt}]\n");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  Manifest manifest() const { return readManifest(folder_ / "m.yaml"); }

  fs::path folder_;
};

Record full() {
  Record record;
  record.id = "a";
  record.map = "field";
  record.date = 20260531;
  record.fingerprint = "0123456789abcdef";
  record.status = "rejected";
  record.probability = 0.25;
  record.expected_error = 0.0123;
  record.heights = "measured";
  record.seconds = 1.5;
  record.message = "no, \"this\"\nis not it";
  record.outline = {{500000.25, 1.0}, {500001.0, 1.0}, {500001.0, 3.0}};
  return record;
}

TEST_F(RecordTest, ReadsBackWhatWasWritten) {
  writeRecord(folder_ / kRecordName, full());
  const std::optional<Record> read = readRecord(folder_);
  ASSERT_TRUE(read);
  EXPECT_EQ(toJson(*read), toJson(full()));
  EXPECT_EQ(read->outline, full().outline);
}

TEST_F(RecordTest, WhatIsDamagedIsNone) {
  EXPECT_FALSE(readRecord(folder_));
  for (const char* text :
       {"", "{", "[]", "{\"format\": 3}", "{\"format\": \"agricolmap-batch-item\", \"id\": 7}"}) {
    write(kRecordName, text);
    EXPECT_FALSE(readRecord(folder_)) << text;
  }
}

// Whatever the answer hangs on changes the fingerprint; asking again does not.
TEST_F(RecordTest, TheFingerprintTellsEveryChange) {
  std::set<std::string> seen;
  const auto fingerprint = [&] {
    const Manifest read = manifest();
    EXPECT_EQ(fingerprintOf(read.strips[0], read), fingerprintOf(read.strips[0], read));
    return fingerprintOf(read.strips[0], read);
  };
  EXPECT_TRUE(seen.insert(fingerprint()).second);
  EXPECT_FALSE(seen.insert(fingerprint()).second);
  for (const char* file : {"drone.las", "a.ply", "prior.txt", "offset.xyz", "a.prj"}) {
    write(file, "longer");
    EXPECT_TRUE(seen.insert(fingerprint()).second) << file;
  }
  fs::last_write_time(folder_ / "a.ply",
                      fs::last_write_time(folder_ / "a.ply") + std::chrono::seconds(1));
  EXPECT_TRUE(seen.insert(fingerprint()).second);
  for (const char* more : {"options: {grid: {cell: 0.03}}", "preset: paper", "keep_rejected: true",
                           "aligned_format: laz", "pictures: false"}) {
    write("m.yaml", std::string("maps: [{id: field, file: drone.las}]\n"
                                "strips: [{id: a, file: a.ply, prior: prior.txt}]\n") +
                        more);
    EXPECT_TRUE(seen.insert(fingerprint()).second) << more;
  }
}

TEST(Summary, QuotesWhatACsvNeedsQuoted) {
  const Record record = full();
  const std::string csv = csvOf(std::span(&record, 1));
  EXPECT_THAT(csv, HasSubstr("\na,field,20260531,rejected,0.2500,0.0123,measured,,1.50,"
                             "\"no, \"\"this\"\"\nis not it\"\n"));
}

TEST(Summary, CountsAndTells) {
  std::vector<Record> records(4, full());
  records[0].status = "accepted";
  records[3].status = "failed";
  EXPECT_EQ(toText(countsOf(records)), "1 accepted, 2 rejected, 1 failed");
  EXPECT_EQ(lineOf(records[1], 4),
            "a     rejected   0.250  1.2 cm  measured    1.5 s  no, \"this\"");
  EXPECT_EQ(lineOf(records[3], 1), "a  failed     no, \"this\"");
  EXPECT_THAT(lineOf(records[0], 1), testing::Not(HasSubstr("this")));
}

}  // namespace
}  // namespace agricolmap::batch
