#include "experiments/runner/child_process.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::experiments {
namespace {

TEST(ChildProcess, EndsAtItsLimitOrByItself) {
  const test::TempDir folder;
  const ChildResult slow = runChild({"/bin/sleep", "20"}, 0.2, folder / "log");
  EXPECT_TRUE(slow.timed_out);
  EXPECT_LT(slow.wall_s, 5.0);
  const ChildResult quick = runChild({"/bin/sh", "-c", "echo so; exit 3"}, 10.0, folder / "log");
  EXPECT_FALSE(quick.timed_out);
  EXPECT_EQ(quick.exit_code, 3);
  std::string word;
  std::ifstream(folder / "log") >> word;
  EXPECT_EQ(word, "so");
  EXPECT_THROW(runChild({"/no/such/program"}, 1.0, folder / "log"), OutputError);
}

}  // namespace
}  // namespace agricolmap::experiments
