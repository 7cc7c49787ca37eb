#include "agricolmap/batch/file_pattern.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::batch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class FilePattern : public ::testing::Test {
 protected:
  void touch(const std::string& name) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << "x";
  }
  std::vector<std::vector<std::string>> parts(const std::string& pattern) {
    std::vector<std::vector<std::string>> all;
    for (const FoundFile& file : filesLike(folder_.path(), pattern)) all.push_back(file.parts);
    return all;
  }
  test::TempDir folder_;
};

TEST_F(FilePattern, WildcardsStandForWhatHasNoSlash) {
  touch("monday/row7.laz");
  touch("monday/row12.laz");
  touch("monday/deep/row3.laz");
  touch("tuesday/row7.las");
  EXPECT_THAT(parts("*/row*.laz"),
              ElementsAre(ElementsAre("monday", "12"), ElementsAre("monday", "7")));
  EXPECT_THAT(parts("*/row?.la[sz]"),
              ElementsAre(ElementsAre("monday", "7", "z"), ElementsAre("tuesday", "7", "s")));
  EXPECT_THAT(parts("*/row[!7]*.laz"), ElementsAre(ElementsAre("monday", "1", "2")));
}

TEST_F(FilePattern, OtherSignsOfExpressionsAreLetters) {
  touch("a+b(1).{x}]^$.laz");
  EXPECT_THAT(parts("a+b(*).{x}]^$.laz"), ElementsAre(ElementsAre("1")));
  EXPECT_THAT(parts("a.b*"), IsEmpty());
  EXPECT_THAT(parts("[z-a]*"), IsEmpty());
}

TEST_F(FilePattern, NamesAreMadeOfWhatWildcardsStandFor) {
  const FoundFile file{"monday/row7.copc.laz", {"monday", "7"}};
  EXPECT_EQ(filledIn("{1}_{name}", file), "monday_row7");
  EXPECT_EQ(filledIn("strip {2}", file), "strip 7");
  EXPECT_THROW(filledIn("{3}", file), UsageError);
  EXPECT_THROW(filledIn("{}", file), UsageError);
}

}  // namespace
}  // namespace agricolmap::batch
