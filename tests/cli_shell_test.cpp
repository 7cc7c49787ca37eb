// What a system has of the program beside itself: manual pages and completions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/cli_fixture.hpp"

namespace agricolmap::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ShellTest : public CliTest {
 protected:
  /// What bash would offer for a line whose last word is unfinished.
  std::string offered(const std::string& line) const {
    const ProgramResult script = runAgricolmap({"document-completion", "bash"});
    const std::string file = write("completion.bash", script.out);
    const std::string ask = "bash -c 'source " + file + "; COMP_WORDS=(" + line +
                            "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _agricolmap;" +
                            " echo \"${COMPREPLY[*]}\"'; exit;";
    return runInShell(ask, {}).out;
  }
};

TEST_F(ShellTest, EveryVerbHasAManualPage) {
  const std::string folder = inFolder("man");
  ASSERT_EQ(runAgricolmap({"document-manuals", folder}).exit_code, 0);
  const auto page = [&](const std::string& name) {
    // Roff writes the minus of a flag with a backslash.
    std::string text = contentOf(folder + "/" + name);
    std::erase(text, '\\');
    return text;
  };
  const std::string whole = page("agricolmap.1");
  for (const std::string& name : entries("man")) {
    const std::string verb = name.substr(0, name.find(".1"));
    if (verb != "agricolmap") {
      EXPECT_THAT(whole, HasSubstr("fB" + verb + "fR(1)"));
    }
    EXPECT_THAT(page(name), HasSubstr("EXIT STATUS"));
  }
  const std::string verb = page("agricolmap-register.1");
  EXPECT_THAT(verb, HasSubstr("fB--priorfR fIVALUEfR"));
  EXPECT_THAT(verb, HasSubstr("fIMOVINGfR"));
  EXPECT_THAT(verb, HasSubstr("--help-all"));
  EXPECT_THAT(whole, Not(HasSubstr("document")));
  expectFailure({"document-manuals", folder}, 4, {"--overwrite"});
}

TEST_F(ShellTest, BashOffersVerbsFlagsAndElseFiles) {
  EXPECT_EQ(offered("agricolmap reg"), "register\n");
  EXPECT_EQ(offered("agricolmap register --dump"), "--dump-config\n");
  EXPECT_EQ(offered("agricolmap --quiet register a.ply --overw"), "--overwrite\n");
  EXPECT_EQ(offered("agricolmap register a.p"), "\n");
  EXPECT_THAT(offered("agricolmap document"), Not(HasSubstr("document")));
  expectFailure({"document-completion", "fish"}, 2, {"bash", "zsh"});
}

}  // namespace
}  // namespace agricolmap::test
