#include "agricolmap/batch/picture/summary_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace agricolmap::batch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(SummaryPage, HoldsEveryStripAndNoMessageAsMarkup) {
  std::vector<Record> records(2);
  records[0].id = "first";
  records[0].status = "accepted";
  records[1].id = "second";
  records[1].status = "failed";
  records[1].message = "</script><script>alert(1)</script>";
  Manifest manifest;
  manifest.file = "<b>.yaml";
  const std::string page = summaryPage(records, manifest, 3.0);
  EXPECT_THAT(page, HasSubstr("<title>1 accepted, 1 failed: &lt;b&gt;.yaml</title>"));
  EXPECT_THAT(page, HasSubstr("<li>first: accepted</li><li>second: failed</li>"));
  EXPECT_THAT(page, HasSubstr(R"("id":"second")"));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
}

TEST(SummaryPage, ABatchOfNothingHasOne) {
  EXPECT_THAT(summaryPage({}, {}, 0.0), HasSubstr("<title>none: </title>"));
}

}  // namespace
}  // namespace agricolmap::batch
