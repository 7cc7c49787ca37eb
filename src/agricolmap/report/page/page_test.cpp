#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "agricolmap/report/page/page_facts.hpp"
#include "agricolmap/report/page/page_text.hpp"
#include "agricolmap/report/page/registration_page.hpp"
#include "agricolmap/report/page/test_page.hpp"
#include "agricolmap/report/test_registration.hpp"

namespace agricolmap::report {
namespace {

using agricolmap::testing::dataOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A registration of clouds with names that mean harm, and its page.
struct HostilePair {
  std::string name = "</script><script>alert(1)</script><!-- scene -->\"'&\xff.ply";
  Cloud fixed;
  Cloud moving;
  pipeline::Registration registration = testing::testRegistration();
  Monitor monitor;

  HostilePair() {
    fixed.name = moving.name = name;
    fixed.xyz = moving.xyz = {{0.0F, 0.0F, 0.0F}, {6.0F, 6.0F, 0.1F}};
    registration.verdict.reasons.push_back(name);
  }
  PageContent content() const {
    const CloudStream stream(fixed);
    RegistrationReportInfo info;
    info.command_line = name;
    PageContent content;
    content.report = registrationJson(stream, moving, registration, monitor, info);
    content.facts =
        pageFacts({stream.facts().origin, moving.origin}, registration, {}, "default", "a reason");
    return content;
  }
};

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(PageText, EscapesWhatWouldBeMarkup) {
  EXPECT_EQ(htmlText("a<b>&\"'"), "a&lt;b&gt;&amp;&quot;&#39;");
  EXPECT_EQ(htmlText("\xff"), "\xEF\xBF\xBD");
  EXPECT_EQ(scriptJson({{"k", "</script>"}}), R"({"k":"\u003c/script>"})");
}

TEST(PageText, Base64IsThatOfTheRfc) {
  const auto of = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(PageText, TemplatesAreFilledOnce) {
  EXPECT_EQ(filledTemplate("a <!-- x --> b <!-- y -->", {{"y", "<!-- x -->"}, {"x", "1"}}),
            "a 1 b <!-- x -->");
  EXPECT_THROW(filledTemplate("a", {{"x", "1"}}), std::logic_error);
}

TEST(RegistrationPage, HostileNamesStayText) {
  const HostilePair pair;
  const std::string page = registrationPage(pair.content());
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_EQ(countOf(page, "</script>"), 5U);
  // The name comes back whole, but for the byte that is no text.
  const auto report = dataOf(page, "report");
  EXPECT_THAT(report["moving"]["path"].get<std::string>(), HasSubstr("</script><script>alert(1)"));
  EXPECT_THAT(dataOf(page, "facts")["headline"].get<std::string>(), HasSubstr("accepted"));
}

TEST(RegistrationPage, WithoutScriptsTheVerdictIsRead) {
  const HostilePair pair;
  const std::string page = registrationPage(pair.content());
  const std::size_t from = page.find("<noscript>");
  const std::string words = page.substr(from, page.find("</noscript>") - from);
  EXPECT_THAT(words, HasSubstr("accepted"));
  EXPECT_THAT(words, HasSubstr("4 of 5 blocks, placed alone, agree with the whole"));
}

TEST(RegistrationPage, WithoutMapsItSaysWhyAndIsSmall) {
  const HostilePair pair;
  const std::string page = registrationPage(pair.content());
  EXPECT_TRUE(dataOf(page, "scene").is_null());
  EXPECT_EQ(dataOf(page, "facts")["scene_missing"], "a reason");
  EXPECT_LT(page.size(), 200'000U);
}

TEST(RegistrationPage, ARejectionWithoutAnyPlaceHasAPage) {
  HostilePair pair;
  pair.registration.transform.reset();
  pair.registration.placed.reset();
  pair.registration.verdict = verdict::rejectBecause("nothing was found");
  const std::string page = registrationPage(pair.content());
  EXPECT_TRUE(dataOf(page, "report")["transform"].is_null());
  EXPECT_TRUE(dataOf(page, "facts")["rigid"].is_null());
  EXPECT_THAT(page, HasSubstr("nothing was found"));
}

TEST(PageFacts, BlocksAreMeasuredAlongTheStrip) {
  pipeline::Registration registration = testing::testRegistration();
  for (verdict::BlockEvidence& block : registration.placed->evidence.blocks) {
    block.moving = registration.placed->pose.inverse() * block.place;
  }
  const auto blocks = blocksFacts(registration);
  ASSERT_EQ(blocks.size(), registration.placed->evidence.blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Eigen::Vector2d& offset = registration.placed->evidence.blocks[i].offset;
    EXPECT_NEAR(std::hypot(blocks[i]["offset_along_m"].get<double>(),
                           blocks[i]["offset_across_m"].get<double>()),
                offset.norm(), 1e-12);
    EXPECT_NEAR(blocks[i]["along_m"].get<double>(), 6.0 * (static_cast<double>(i) + 0.5) / 5.0,
                1e-9);
  }
}

TEST(PageFacts, OptionsSayWhatDiffersFromTheDefaults) {
  pipeline::RegistrationOptions options;
  options.grid.cell = 0.03;
  for (const auto& option : optionsFacts(options, "default")) {
    EXPECT_EQ(option["value"] != option["default"], option["path"] == "grid.cell") << option;
  }
}

TEST(PageFacts, TheNearestRigidTransformLaysTheMiddleRightAndSaysWhatItMisses) {
  pipeline::Registration registration = testing::testRegistration();
  registration.maps.moving_box = {Eigen::Vector2d(2.0, 4.0), Eigen::Vector2d(8.0, 6.0)};
  Eigen::Affine3d& affine = registration.transform->local_fixed_from_moving;
  affine = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * Eigen::Scaling(1.1, 1.1, 1.0);
  const auto rigid = rigidFacts({}, registration);
  EXPECT_NEAR(rigid["quaternion_xyzw"][2].get<double>(), std::sin(0.15), 1e-12);
  EXPECT_NEAR(rigid["most_off_m"].get<double>(), 0.1 * std::hypot(3.0, 1.0), 1e-9);
  const Eigen::Vector3d middle(5.0, 5.0, 0.0);
  const Eigen::Vector3d laid = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * middle +
                               Eigen::Vector3d(rigid["local_shift_m"][0], rigid["local_shift_m"][1],
                                               rigid["local_shift_m"][2]);
  EXPECT_LT((laid - affine * middle).norm(), 1e-9);
}

}  // namespace
}  // namespace agricolmap::report
