#ifdef AGRICOLMAP_HAS_LASZIP
#include "agricolmap/io/las/laszip_library.hpp"

#include <gtest/gtest.h>

#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

TEST(LaszipLibrary, IsFoundByTheNameThatItWasBuiltWith) {
  EXPECT_TRUE(hasLaz());
  EXPECT_NE(laszip()->create, nullptr);
  EXPECT_NE(laszip()->close_writer, nullptr);
}

TEST(LaszipLibrary, NoneOfThatNameOrWithOtherFunctionsIsNone) {
  EXPECT_FALSE(loadLaszip("liblaszip.so.of_another_age"));
  EXPECT_FALSE(loadLaszip("libm.so.6"));
}

}  // namespace
}  // namespace agricolmap::io
#endif
